#include "transport/solve.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "base/error.h"
#include <math.h>

// Weights of what is held small beside the loss: how the velocity changes, its size, folds.
#define W_CHANGE 2e-3f
#define W_SIZE 2e-5f
#define W_FOLD 1.0f
#define FOLD_FROM 0.05f // determinants below this

/* Part of a solution: which grids move. Bit l of `grids` is grid l. */
typedef struct Stage {
    int iterations;
    unsigned grids;
    float step;   // of a node, px² per px of its grid
    bool settles; // the step falls to a seventh
} Stage;

static const Stage stages[] = {
    {60, 8 | 4, 0.25f, false},
    {60, 8 | 4 | 2, 0.15f, false},
    {140, 8 | 4 | 2 | 1, 0.10f, true},
};

/* Adam's moments of one grid [Kingma15]. */
typedef struct Moments {
    float *first, *second;
} Moments;

typedef struct Solver {
    const FlTransportProblem *problem;
    FlPotential *potential, by_node;
    FlFlowMap map; // its determinant is what ink of a density of 1 becomes
    float *sum, *velocity;
    float *by_jacobian, *by_velocity; // derivatives of the loss
    Moments moments[FL_POTENTIAL_GRIDS];
    float decay[2]; // powers of Adam's constants
} Solver;

static void clear_moments(Solver *solver)
{
    for (int l = 0; l < FL_POTENTIAL_GRIDS; l++) {
        free(solver->moments[l].first);
        free(solver->moments[l].second);
        solver->moments[l] = (Moments){0};
    }
}

static void solver_clear(Solver *solver)
{
    clear_moments(solver);
    fl_potential_clear(&solver->by_node);
    fl_flow_map_clear(&solver->map);
    float *const buffers[] = {solver->sum, solver->velocity, solver->by_jacobian,
                              solver->by_velocity};
    for (size_t k = 0; k < G_N_ELEMENTS(buffers); k++)
        free(buffers[k]);
}
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Solver, solver_clear)

static bool solver_init(Solver *solver, const FlTransportProblem *problem, FlPotential *potential,
                        GError **error)
{
    const size_t n = (size_t)problem->width * problem->height;
    *solver = (Solver){.problem = problem, .potential = potential};
    return fl_potential_init(&solver->by_node, problem->width, problem->height, error) &&
           fl_flow_map_init(&solver->map, problem->width, problem->height, true, error) &&
           (solver->sum = fl_alloc(n, sizeof(float), "a potential", error)) &&
           (solver->by_jacobian = fl_alloc(n, sizeof(float), "a derivative", error)) &&
           (solver->velocity = fl_alloc(2 * n, sizeof(float), "a velocity", error)) &&
           (solver->by_velocity = fl_alloc(2 * n, sizeof(float), "a derivative", error));
}

static bool fresh_moments(Solver *solver, GError **error)
{
    clear_moments(solver);
    solver->decay[0] = solver->decay[1] = 1;
    for (int l = 0; l < FL_POTENTIAL_GRIDS; l++) {
        const size_t n = fl_potential_nodes(solver->potential, l);
        if (!(solver->moments[l].first = fl_alloc(n, sizeof(float), "moments", error)) ||
            !(solver->moments[l].second = fl_alloc(n, sizeof(float), "moments", error)))
            return false;
    }
    return true;
}

/* Adds what the velocity's size and change cost to the derivative. */
static void add_smoothness(Solver *solver)
{
    const int w = solver->problem->width, h = solver->problem->height;
    const float size = 2 * W_SIZE / (float)(w * h);
    const float change = 2 * W_CHANGE / (float)(w * h);
    const float *v = solver->velocity;
    float *by = solver->by_velocity;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            const size_t p = (size_t)y * w + x;
            const size_t q[2] = {(size_t)y * w + (size_t)((x + 1) % w),
                                 (size_t)((y + 1) % h) * w + x};
            for (size_t c = 0; c < 2; c++) {
                by[2 * p + c] += size * v[2 * p + c];
                for (int k = 0; k < 2; k++) {
                    const float step = change * (v[2 * q[k] + c] - v[2 * p + c]);
                    by[2 * q[k] + c] += step;
                    by[2 * p + c] -= step;
                }
            }
        }
}

/* Adds the cost of determinants that are nearly or below 0. */
static void add_folds(Solver *solver)
{
    const size_t n = (size_t)solver->problem->width * solver->problem->height;
    for (size_t p = 0; p < n; p++) {
        const float below = FOLD_FROM - solver->map.jacobian[p];
        if (below > 0)
            solver->by_jacobian[p] -= 2 * W_FOLD * below / (float)n;
    }
}

/* The mean squared difference from the picture. */
static float picture_loss(Solver *solver)
{
    const FlTransportProblem *problem = solver->problem;
    const size_t n = (size_t)problem->width * (size_t)problem->height;
    double loss = 0;
    for (size_t i = 0; i < n; i++) {
        const float more = solver->map.jacobian[i] - problem->picture[i];
        loss += (double)more * (double)more;
        solver->by_jacobian[i] = 2 * more / (float)n;
    }
    return (float)(loss / (double)n);
}

/* The loss of the potential as it is; its derivative by node into by_node. */
static float derive(Solver *solver, GError **error)
{
    fl_potential_sum(solver->potential, solver->sum);
    fl_velocity(&solver->map, solver->sum, solver->velocity);
    fl_flow_map_run(&solver->map, solver->velocity);
    const float loss = picture_loss(solver);
    add_folds(solver);
    if (!fl_flow_map_adjoint(&solver->map, solver->by_jacobian, solver->by_velocity, error))
        return -1;
    add_smoothness(solver);
    fl_velocity_adjoint(&solver->map, solver->by_velocity, solver->sum);
    fl_potential_adjoint(solver->sum, &solver->by_node);
    return loss;
}

static void step(Solver *solver, unsigned grids, float length)
{
    const float b1 = 0.9f, b2 = 0.95f;
    solver->decay[0] *= b1, solver->decay[1] *= b2;
    for (int l = 0; l < FL_POTENTIAL_GRIDS; l++) {
        const float far = length * (float)(2 << l);
        const Moments *m = &solver->moments[l];
        for (size_t i = 0; grids >> l & 1 && i < fl_potential_nodes(solver->potential, l); i++) {
            const float g = solver->by_node.grid[l][i];
            m->first[i] = b1 * m->first[i] + (1 - b1) * g;
            m->second[i] = b2 * m->second[i] + (1 - b2) * g * g;
            solver->potential->grid[l][i] -=
                far * (m->first[i] / (1 - solver->decay[0])) /
                (sqrtf(m->second[i] / (1 - solver->decay[1])) + 1e-12f);
        }
    }
}

static bool interrupted(GError **error)
{
    return fl_fail(error, FL_ERROR_INTERRUPTED, "interrupted");
}

/* The report of a run, and its progress. */
typedef struct Report {
    FlTransportProgress progress; // NULL: not called
    void *data;
    int done, total;
} Report;

static bool run_stage(Solver *solver, const Stage *stage, int n, Report *report, GError **error)
{
    const FlTransportProblem *problem = solver->problem;
    if (!fresh_moments(solver, error))
        return false;
    for (int k = 0; k < n; k++) {
        const float fall = fl_smooth((float)k / (float)n);
        const float loss = derive(solver, error);
        if (loss < 0)
            return false;
        report->done++;
        step(solver, stage->grids,
             problem->pace * stage->step * (stage->settles ? 1 - 0.85f * fall : 1));
        if (report->progress && !report->progress(report->data, report->done, report->total, loss))
            return interrupted(error);
    }
    return true;
}

bool fl_transport_solve(const FlTransportProblem *problem, float effort, FlPotential *potential,
                        FlTransportProgress progress, void *data, GError **error)
{
    g_auto(Solver) solver = {0};
    Report report = {progress, data, 0, 0};
    if (!solver_init(&solver, problem, potential, error))
        return false;
    for (size_t s = 0; s < G_N_ELEMENTS(stages); s++)
        report.total += (int)((float)stages[s].iterations * effort);
    for (size_t s = 0; s < G_N_ELEMENTS(stages); s++)
        if (!run_stage(&solver, &stages[s], (int)((float)stages[s].iterations * effort), &report,
                       error))
            return false;
    return true;
}
