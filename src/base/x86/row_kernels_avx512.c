#define ROWS(name) name##_avx512
#define ROWS_NAME "avx512"
#define ROWS_FLAGS (FL_CPU_AVX2 | FL_CPU_AVX512)
#include "base/row_kernels.inc"
