#define ROWS(name) name##_avx512
#define ROWS_NAME "avx512"
#include "base/row_kernels.inc"
