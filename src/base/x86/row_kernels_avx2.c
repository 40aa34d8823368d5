#define ROWS(name) name##_avx2
#define ROWS_NAME "avx2"
#define ROWS_FLAGS FL_CPU_AVX2
#include "base/row_kernels.inc"
