/* The potential of an ink: its derivatives, and the search for one. */
#include "base/rng.h"
#include "transport/flow_map.h"
#include "transport/potential.h"
#include "transport/solve.h"

#include <math.h>

#define N 48 // px, the sides of a torus

static float noise(uint64_t key, size_t i)
{
    FlRng rng = {fl_key(key, i)};
    return 2 * fl_rng_float(&rng) - 1;
}

/* A weighted sum of the determinants is derived by the potential. */
typedef struct Problem {
    FlPotential potential;
    float by[N * N];
} Problem;

static Problem *problem_new(void)
{
    Problem *p = g_new0(Problem, 1);
    g_assert_true(fl_potential_init(&p->potential, N, N, NULL));
    for (int l = 0; l < FL_POTENTIAL_GRIDS; l++)
        for (size_t i = 0; i < fl_potential_nodes(&p->potential, l); i++)
            p->potential.grid[l][i] = 0.6f * noise((uint64_t)l, i) * (float)(1 << l);
    for (size_t i = 0; i < (size_t)N * N; i++) {
        p->by[i] = noise(10, i) + noise(11, i);
    }
    return p;
}

static void problem_free(Problem *p)
{
    fl_potential_clear(&p->potential);
    g_free(p);
}

static double value_of(const Problem *p)
{
    g_auto(FlFlowMap) map = {0};
    g_autofree float *sum = g_new(float, N *N), *velocity = g_new(float, 2 * N * N);
    g_assert_true(fl_flow_map_init(&map, N, N, true, NULL));
    fl_potential_sum(&p->potential, sum);
    fl_velocity(&map, sum, velocity);
    fl_flow_map_run(&map, velocity);
    double value = 0;
    for (size_t i = 0; i < (size_t)N * N; i++)
        value += (double)p->by[i] * map.jacobian[i];
    return value;
}

static void derivative_of(const Problem *p, FlPotential *by_node)
{
    g_auto(FlFlowMap) map = {0};
    g_autofree float *sum = g_new(float, N *N), *velocity = g_new(float, 2 * N * N);
    g_assert_true(fl_flow_map_init(&map, N, N, true, NULL));
    fl_potential_sum(&p->potential, sum);
    fl_velocity(&map, sum, velocity);
    fl_flow_map_run(&map, velocity);
    g_assert_true(fl_flow_map_adjoint(&map, p->by, velocity, NULL));
    fl_velocity_adjoint(&map, velocity, sum);
    g_assert_true(fl_potential_init(by_node, N, N, NULL));
    fl_potential_adjoint(sum, by_node);
}

/* The derivative along a direction of all nodes against central differences. Bilinear samples have
 * kinks, which a small step along many nodes averages. */
static void adjoints_agree_with_differences(void)
{
    const float step = 0.1f; // length in all nodes
    Problem *p = problem_new();
    g_auto(FlPotential) by = {0};
    derivative_of(p, &by);
    for (int l = 0; l < FL_POTENTIAL_GRIDS; l++) {
        double expected = 0, length = 0;
        const size_t n = fl_potential_nodes(&by, l);
        g_autofree float *kept = g_memdup2(p->potential.grid[l], n * sizeof(float));
        for (size_t i = 0; i < n; i++) // along the derivative itself, where it is largest
            length += (double)by.grid[l][i] * by.grid[l][i];
        length = sqrt(length);
        double value[2];
        for (int side = 0; side < 2; side++) {
            for (size_t i = 0; i < n; i++)
                p->potential.grid[l][i] =
                    kept[i] + (side ? step : -step) * (float)(by.grid[l][i] / length);
            value[side] = value_of(p);
        }
        memcpy(p->potential.grid[l], kept, n * sizeof(float));
        expected = (value[1] - value[0]) / (2 * (double)step);
        g_test_message("grid %d: adjoint %.5f, differences %.5f", l, length, expected);
        g_assert_cmpfloat(fabs(length - expected), <, 0.01 * fabs(expected) + 0.006);
    }
    problem_free(p);
}

/* A picture of stripes 12 px apart, mean 1. */
static float *striped(int n)
{
    float *picture = g_new(float, n *n);
    for (int i = 0; i < n * n; i++)
        picture[i] = 1 + 0.8f * sinf((float)(i / n + i % n / 3) * 0.5236f);
    return picture;
}

/* The mean squared distance from the picture. */
static double distance(const float *picture, const float *ink, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++) {
        const double more = (double)picture[i] - (ink ? (double)ink[i] : 1);
        sum += more * more;
    }
    return sum / n;
}

static void a_solution_looks_like_its_picture(void)
{
    enum { n = 64 };
    g_autofree float *picture = striped(n), *sum = g_new(float, n *n);
    g_autofree float *velocity = g_new(float, 2 * n * n);
    g_auto(FlPotential) potential = {0};
    g_auto(FlFlowMap) map = {0};
    g_assert_true(fl_potential_init(&potential, n, n, NULL) &&
                  fl_flow_map_init(&map, n, n, true, NULL));
    const FlTransportProblem problem = {n, n, picture, 1};
    g_assert_true(fl_transport_solve(&problem, 1, &potential, NULL, NULL, NULL));
    fl_potential_sum(&potential, sum);
    fl_velocity(&map, sum, velocity);
    fl_flow_map_run(&map, velocity);
    const double before = distance(picture, NULL, n * n),
                 after = distance(picture, map.jacobian, n * n);
    g_test_message("distance %.4f of the flat ink, %.4f of the solution", before, after);
    g_assert_cmpfloat(after, <, 0.05 * before);
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
#define TEST(name) g_test_add_func("/potential/" #name, name)
    TEST(adjoints_agree_with_differences);
    TEST(a_solution_looks_like_its_picture);
    return g_test_run();
}
