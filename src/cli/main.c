/* fluidy-svg: words and exit codes only; the work is in the library. */
#include <fluidy/fluidy.h>
#include <stdio.h>

int main(void)
{
    printf("fluidy-svg %s\n", fl_version());
    return 0;
}
