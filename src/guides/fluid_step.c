/*
 * The flow of one frame, from what the outline shows (fluid_shape.c):
 *
 *   carry      the velocity of the frame before, moved along itself
 *   forces     swirl and buoyancy; stiffness and drag
 *   sources    what the contour pushes, what comes in
 *   project    to the nearest flow without divergence: pressure.h
 */
#include "guides/fluid_data.h"

#include "base/alloc.h"
#include "base/curves.h"
#include <math.h>
#include <string.h>

#define RINGS 12        // cells by which a velocity is continued outwards
#define RESTS .12f      // slower than this a contour rests
#define BAND 5          // below the contour, in which buoyancy sets in
#define CONFINEMENT .1f // of a swirl of 1
#define FASTEST_IN 2.   // at which fluid comes in
#define SLOWS .8f       // factor on the velocity of what rests
#define STILL .01f      // a velocity that is none

/** The velocities across the left faces, or the upper ones. */
typedef struct Faces {
    float *kept, *next;
    const float *open;
    int beside;   // from a cell to the one across its face
    float dx, dy; // from the middle of a cell to its face
} Faces;

static Faces left_faces(const FlFluid *f)
{
    return (Faces){f->u, f->next_u, f->open_u, -1, -.5f, 0};
}

static Faces upper_faces(const FlFluid *f)
{
    return (Faces){f->v, f->next_v, f->open_v, -f->stride, 0, -.5f};
}

/* ---- kinds and grid -----------------------------------------------------------------------------
 */

FlFluidDials fl_fluid_dials(const FlRegionSettings *settings)
{
    static const FlFluidDials kinds[] = {
        [FL_FLUID_NONE] = {.memory = 0},
        [FL_FLUID_PLAIN] = {.memory = 1, .emit = 1, .swirl = 1, .stiff = .03f},
        [FL_FLUID_SMOKE] = {.memory = 1, .emit = 1, .swirl = 1, .buoyancy = 2},
        [FL_FLUID_WATER] = {.memory = .95f, .swirl = .5f},
        [FL_FLUID_FIRE] =
            {.memory = .9f, .emit = .3f, .swirl = 1, .buoyancy = 2, .burn = 1, .rise = 1},
        [FL_FLUID_HONEY] = {.memory = .8f, .stiff = .2f},
    };
    FlFluidDials dials = kinds[settings->fluid];
    const double up = settings->fluid_up * (G_PI / 180);
    const struct {
        double given;
        float *dial;
    } given[] = {{settings->fluid_memory, &dials.memory},
                 {settings->fluid_emit, &dials.emit},
                 {settings->fluid_buoyancy, &dials.buoyancy},
                 {settings->fluid_swirl, &dials.swirl},
                 {settings->fluid_drag, &dials.drag}};
    for (size_t k = 0; k < G_N_ELEMENTS(given); k++)
        if (!isnan(given[k].given))
            *given[k].dial = (float)given[k].given;
    dials.up[0] = (float)sin(up), dials.up[1] = -(float)cos(up);
    return dials;
}

FlFluid *fl_fluid_new(FlRect part, FlRect page, const FlFluidDials *dials, GError **error)
{
    g_autoptr(FlFluid) f = g_new0(FlFluid, 1);
    float **const planes[] = {&f->u,      &f->v,        &f->pressure, &f->rest,     &f->pace,
                              &f->rise,   &f->distance, &f->moved[0], &f->moved[1], &f->before,
                              &f->next_u, &f->next_v,   &f->open_u,   &f->open_v,   &f->speed,
                              &f->nx,     &f->ny,       &f->length,   &f->a,        &f->b,
                              &f->c,      &f->d,        &f->column,   &f->line};
    const char *what = "a fluid";
    fl_fluid_lay_grid(f, part, page);
    f->dials = *dials;
    f->parts = g_array_new(FALSE, TRUE, sizeof(FlFluidPart));
    const size_t n = (size_t)f->n;
    if (!(f->memory = fl_alloc(G_N_ELEMENTS(planes) * n, sizeof *f->memory, what, error)) ||
        !(f->missing = fl_alloc(n, sizeof *f->missing, what, error)) ||
        !(f->label = fl_alloc(2 * n, sizeof *f->label, what, error)) ||
        !(f->ring = fl_alloc(4 * n, 1, what, error)) || !(f->solver = fl_pressure_new(n, error)))
        return NULL;
    for (size_t k = 0; k < G_N_ELEMENTS(planes); k++)
        *planes[k] = f->memory + k * n;
    f->queue = f->label + n, f->solved = f->ring + n;
    f->inner = f->solved + n, f->wall = f->inner + n;
    fl_fluid_lay_cells(f);
    return g_steal_pointer(&f);
}

void fl_fluid_free(FlFluid *f)
{
    if (!f)
        return;
    free(f->memory);
    free(f->missing);
    free(f->label);
    free(f->ring);
    g_array_unref(f->parts);
    fl_pressure_free(f->solver);
    g_free(f);
}

void fl_fluid_way(const FlFluid *f, float x, float y, float way[2])
{
    const float u = fl_fluid_sample(f, f->u, x + .5f, y), v = fl_fluid_sample(f, f->v, x, y + .5f);
    way[0] = fl_fluid_sample(f, f->u, x - .5f * u + .5f, y - .5f * v);
    way[1] = fl_fluid_sample(f, f->v, x - .5f * u, y - .5f * v + .5f);
}

/* ---- contour ------------------------------------------------------------------------------------
 */

/** The pace of each part's contour: it follows at once where that gets faster, slowly where it gets
 * slower. */
static void find_pace(FlFluid *f)
{
    for (int c = 0; c < f->n; c++) {
        FlFluidPart *part = fl_fluid_part(f, c);
        if (!part)
            continue;
        part->was += (double)f->pace[c], part->rise += f->rise[c];
        if (fabsf(f->distance[c]) < 1 && fabsf(f->speed[c]) >= RESTS)
            part->pace += (double)(f->speed[c] * f->speed[c]), part->rests = false;
    }
    for (guint i = 0; i < f->parts->len; i++) {
        FlFluidPart *part = &g_array_index(f->parts, FlFluidPart, i);
        // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): there is a part
        const double was = part->was / part->cells, now = part->pace / MAX(part->contour, 1);
        part->pace = now > was ? .5 * (now + was) : .9 * was + .1 * now;
        part->pace *= part->rests ? (double)SLOWS : 1;
        part->rise /= (float)part->cells;
    }
    for (int c = 0; c < f->n; c++)
        f->pace[c] = fl_fluid_part(f, c) ? (float)fl_fluid_part(f, c)->pace : 0;
}

/* ---- velocity -----------------------------------------------------------------------------------
 */

/** The part on either side of the face of a cell; NULL: there is none. */
static FlFluidPart *part_beside(const FlFluid *f, const Faces *faces, int c)
{
    FlFluidPart *part = fl_fluid_part(f, c);
    return part || c + faces->beside < 0 ? part : fl_fluid_part(f, c + faces->beside);
}

/** Moves the velocities of the frame before along themselves. */
static void carry(FlFluid *f, Faces faces)
{
    for (int c = 0; c < f->n; c++) {
        const float x = f->column[c] + faces.dx, y = f->line[c] + faces.dy;
        FlFluidPart *part = part_beside(f, &faces, c);
        float way[2];
        faces.next[c] = 0;
        if (f->distance[c] < -FL_FLUID_NEAR)
            continue;
        fl_fluid_way(f, x, y, way);
        faces.next[c] =
            f->dials.memory * (part && part->rests ? SLOWS : 1) *
            fl_fluid_sample(f, faces.kept, x - faces.dx - way[0], y - faces.dy - way[1]);
        if (part && fabsf(faces.next[c]) > STILL)
            part->fresh = false;
    }
}

/** The curl of the velocity, and how strong it is nearby. */
static void find_whirls(FlFluid *f, float *curl, float *strength)
{
    const int s = f->stride;
    const float *u = f->next_u, *v = f->next_v;
    fl_fluid_clear(f, curl);
    fl_fluid_clear(f, strength);
    for (int c = s; c < f->n - s; c++)
        if (f->inner[c] && f->distance[c] > .5f) {
            curl[c] = .25f * (v[c + 1] + v[c + s + 1] - v[c - 1] - v[c + s - 1] - u[c + s] -
                              u[c + s + 1] + u[c - s] + u[c - s + 1]);
            strength[c] = fabsf(curl[c]);
        }
    for (int k = 0; k < 4; k++) {
        fl_fluid_blur(f, strength, 1, f->d);
        fl_fluid_blur(f, strength, s, f->d);
    }
}

/** Vorticity confinement, and buoyancy: a force that fades towards the contour, where its curl
 * makes whirls; it is free of the unit of time, and 0 where the contour rests. */
static void add_forces(FlFluid *f)
{
    float *curl = f->a, *strength = f->b, *along[2] = {f->c, f->d};
    const FlFluidDials *dials = &f->dials;
    const int s = f->stride;
    find_whirls(f, curl, strength);
    fl_fluid_clear(f, along[0]);
    fl_fluid_clear(f, along[1]);
    for (int c = s; c < f->n - s; c++) {
        const FlFluidPart *part = fl_fluid_part(f, c);
        if (!part)
            continue;
        const float dx = .5f * (strength[c + 1] - strength[c - 1]);
        const float dy = .5f * (strength[c + s] - strength[c - s]);
        const float twist =
            CONFINEMENT * dials->swirl * curl[c] / (sqrtf(dx * dx + dy * dy) + 1e-4f);
        const float lift =
            dials->buoyancy * (float)part->pace / BAND * fl_smooth(f->distance[c] / BAND);
        along[0][c] = twist * dy + lift * dials->up[0];
        along[1][c] = -twist * dx + lift * dials->up[1];
    }
    for (int c = s; c < f->n - s; c++) {
        f->next_u[c] += .5f * (along[0][c] + along[0][c - 1]);
        f->next_v[c] += .5f * (along[1][c] + along[1][c - s]);
    }
}

/** Pulls faces to the affine motion of their part, as far as that is trusted; near the contour more
 * so; all of the way where it has no past or is too thin to flow. */
static void stiffen(FlFluid *f, Faces faces, int axis)
{
    for (int c = 0; c < f->n; c++) {
        const FlFluidPart *part = part_beside(f, &faces, c);
        float motion[2];
        if (!part)
            continue;
        const float pull = f->dials.stiff + f->dials.drag / (1 + MAX(f->distance[c], 0));
        const float share = part->fresh || !part->flows ? 1 : CLAMP(pull, (float)part->trust, 1);
        fl_fluid_move(&part->affine, f->column[c] + faces.dx, f->line[c] + faces.dy, motion);
        faces.next[c] += share * (motion[axis] - faces.next[c]);
    }
}

/* ---- sources ------------------------------------------------------------------------------------
 */

/** The weight of a cell's contour as an emitter: it has to rest for some frames. */
static double emitter(const FlFluid *f, int c)
{
    return (double)(MAX(f->rest[c] - .25f, 0) * f->length[c]);
}

/** Counts the frames that contour rests, and the volume that it pushes out of each cell and part.
 */
static void push_by_contour(FlFluid *f)
{
    for (int c = 0; c < f->n; c++) {
        FlFluidPart *part = fl_fluid_part(f, c);
        const bool rests = part && part->known && f->length[c] > 0 && fabsf(f->speed[c]) < RESTS;
        const float burn = f->speed[c] < 0 ? f->dials.burn : 0;
        f->missing[c] = 0;
        f->rest[c] = rests ? MIN(f->rest[c] + .125f, 1) : .5f * f->rest[c];
        if (!part)
            continue;
        f->missing[c] = -(double)((1 - burn) * f->speed[c] * f->length[c]);
        part->growth -= f->missing[c];
        part->emitters += emitter(f, c);
        part->area += (double)fl_fluid_open_area(f, c);
    }
}

/** Brings in what parts grow by: in the share `emit`, but no faster than FASTEST_IN, through
 * contour that rests; the rest, and that by which they swell, evenly. Parts that are open to the
 * page take it from there. */
static void let_in_growth(FlFluid *f)
{
    for (int c = 0; c < f->n; c++) {
        const FlFluidPart *part = fl_fluid_part(f, c);
        if (!part || part->open[0] || part->open[1] || part->open[2] || part->open[3])
            continue;
        const double most = (1 - part->even) * (double)f->dials.emit * MAX(part->growth, 0);
        const double in = MIN(most, FASTEST_IN * part->emitters);
        f->missing[c] += (part->growth - in) * (double)fl_fluid_open_area(f, c) / part->area;
        f->missing[c] += in > 0 ? in * emitter(f, c) / part->emitters : 0;
    }
}

/** The upward part of the normal of a cell's contour, -1..1. */
static float facing_up(const FlFluid *f, int c)
{
    return f->nx[c] * f->dials.up[0] + f->ny[c] * f->dials.up[1];
}

/** The passage through a cell's contour: out if > 0, through contour that moves and faces up; in if
 * < 0, through contour that rests and faces down. */
static double passage(const FlFluid *f, int c)
{
    const float up = facing_up(f, c), rests = MAX(f->rest[c] - .25f, 0) / .75f;
    return (double)((up < 0 ? rests : 1 - rests) * f->length[c] * up);
}

/** The speed at which each part rises: the highest at its top, slowly falling. */
static void find_rise(FlFluid *f)
{
    for (int c = 0; c < f->n; c++) {
        FlFluidPart *part = fl_fluid_part(f, c);
        const float up = facing_up(f, c);
        const double way = part ? passage(f, c) : 0;
        if (way < 0)
            part->in -= way;
        else if (way > 0)
            part->out += way;
        if (part && f->length[c] > 0 && up > .3f && f->speed[c] > 0) {
            const double speed = (double)MIN(f->speed[c] / up, 4);
            part->top[0] += speed, part->top[1] += speed * speed;
        }
    }
    for (guint l = 0; l < f->parts->len; l++) {
        FlFluidPart *part = &g_array_index(f->parts, FlFluidPart, l);
        const float now = part->top[0] > 0 ? (float)(part->top[1] / part->top[0]) : 0;
        part->rise = MAX(.95f * part->rise, now) * (part->rests ? SLOWS : 1);
    }
}

/** Lets fluid rise through the parts: as much leaves as enters, at most at twice the speed. */
static void let_through(FlFluid *f)
{
    find_rise(f);
    for (int c = 0; c < f->n; c++) {
        const FlFluidPart *part = fl_fluid_part(f, c);
        f->rise[c] = part ? part->rise : 0;
        if (!part || part->in <= .5 || part->out <= .5)
            continue;
        const double way = passage(f, c), in = MIN(1, 2 * part->out / part->in);
        f->missing[c] -=
            (double)(f->dials.rise * part->rise) * in * way * (way < 0 ? 1 : part->in / part->out);
    }
}

/* ---- projection ---------------------------------------------------------------------------------
 */

/** Makes parts that flow incompressible. Faces with a velocity become ring 1, others 0, and those
 * on the grid's border a wall. */
static void take_pressure(FlFluid *f, Faces faces, float fastest)
{
    for (int c = 0; c < f->n; c++) {
        const int other = c + faces.beside;
        const bool open = !f->wall[c] && faces.open[c] > 0 && part_beside(f, &faces, c);
        if (open && (f->solved[c] || f->solved[other]))
            faces.next[c] -= f->pressure[c] - f->pressure[other];
        faces.next[c] = open ? CLAMP(faces.next[c], -fastest, fastest) : 0;
        f->ring[c] = f->wall[c] ? UINT8_MAX : open;
    }
}

/** Continues the velocity of a face of a ring from the rings within; the next ring is queued. */
static void continue_face(FlFluid *f, float *next, int c, int *last)
{
    const int s = f->stride, around[] = {1, -1, s, -s, s + 1, s - 1, 1 - s, -s - 1};
    const int ring = f->ring[c];
    float sum = 0, weights = 0;
    for (int d = 0; d < 8; d++) {
        const int other = c + around[d];
        if (f->ring[other] == 0 && ring <= RINGS) {
            f->ring[other] = (uint8_t)(ring + 1), f->queue[(*last)++] = other;
        } else if (f->ring[other] != 0 && f->ring[other] < ring) {
            const float weight = d < 4 ? 1 : .7f;
            sum += weight * next[other], weights += weight;
        }
    }
    if (ring > 1)
        next[c] = sum / weights;
}

static void continue_outwards(FlFluid *f, Faces faces)
{
    int last = 0;
    for (int c = 0; c < f->n; c++)
        if (f->ring[c] == 1)
            continue_face(f, faces.next, c, &last);
    for (int k = 0; k < last; k++)
        continue_face(f, faces.next, f->queue[k], &last);
    for (int y = 0; y < f->rows; y++) { // the border is as what lies beside it
        float *row = faces.next + y * f->stride;
        row[0] = row[1], row[f->stride - 1] = row[f->stride - 2];
    }
    const size_t bytes = (size_t)f->stride * sizeof(float);
    memcpy(faces.next, faces.next + f->stride, bytes);
    memcpy(faces.next + f->n - f->stride, faces.next + f->n - 2 * f->stride, bytes);
    memcpy(faces.kept, faces.next, (size_t)f->n * sizeof(float));
}

static void project(FlFluid *f)
{
    const int s = f->stride;
    float fastest = FL_FLUID_FASTEST;
    for (int c = 0; c < f->n; c++) {
        const FlFluidPart *part = fl_fluid_part(f, c);
        f->solved[c] = part && part->flows;
        if (f->solved[c])
            f->missing[c] -=
                (double)(f->open_u[c + 1] * f->next_u[c + 1] - f->open_u[c] * f->next_u[c] +
                         f->open_v[c + s] * f->next_v[c + s] - f->open_v[c] * f->next_v[c]);
    }
    const FlCells cells = {s, f->n, f->open_u, f->open_v, f->solved};
    fl_pressure_solve(f->solver, &cells, f->missing, f->pressure);
    for (guint l = 0; l < f->parts->len; l++) {
        const FlFluidPart *part = &g_array_index(f->parts, FlFluidPart, l);
        fastest = MAX(fastest, FL_FLUID_FASTEST + fl_fluid_bulk_speed(part) +
                                   2 * (float)fabs(part->rigid.p[2]));
    }
    take_pressure(f, left_faces(f), fastest);
    continue_outwards(f, left_faces(f));
    take_pressure(f, upper_faces(f), fastest);
    continue_outwards(f, upper_faces(f));
}

/* ---- frames -------------------------------------------------------------------------------------
 */

void fl_fluid_begin(FlFluid *f)
{
    fl_fluid_clear(f, f->moved[0]);
    fl_fluid_clear(f, f->moved[1]);
}

/** Adds the flow of the frame to the displacement of those before. */
static void add_displacement(FlFluid *f)
{
    float *before[2] = {f->a, f->b};
    for (int k = 0; k < 2; k++)
        memcpy(before[k], f->moved[k], (size_t)f->n * sizeof(float));
    for (int c = 0; c < f->n; c++) {
        const float x = f->column[c], y = f->line[c];
        float way[2];
        fl_fluid_way(f, x, y, way);
        for (int k = 0; k < 2; k++)
            f->moved[k][c] = way[k] + fl_fluid_sample(f, before[k], x - way[0], y - way[1]);
    }
}

void fl_fluid_step(FlFluid *f, const FlOutline *before, const FlOutline *now)
{
    if (before == now) {
        for (int c = 0; c < f->n; c++)
            f->u[c] *= SLOWS, f->v[c] *= SLOWS, f->pace[c] *= SLOWS, f->rise[c] *= SLOWS;
        return;
    }
    if (!f->follows || before->empty) {
        for (int k = 0; k < 6; k++) // all that is kept but the displacement
            fl_fluid_clear(f, f->memory + k * f->n);
        fl_fluid_measure(f, before, f->distance);
    }
    f->follows = true;
    memcpy(f->before, f->distance, (size_t)f->n * sizeof(float));
    fl_fluid_measure(f, now, f->distance);
    fl_fluid_read_shape(f);
    find_pace(f);
    carry(f, left_faces(f));
    carry(f, upper_faces(f));
    add_forces(f);
    stiffen(f, left_faces(f), 0);
    stiffen(f, upper_faces(f), 1);
    push_by_contour(f);
    let_in_growth(f);
    let_through(f);
    project(f);
    add_displacement(f);
}

/** True if a cell or one beside it is in a part whose motion is known. */
static bool has_fluid(const FlFluid *f, int c)
{
    bool found = false;
    for (int y = -1; y <= 1 && !found; y++)
        for (int x = -1; x <= 1 && !found; x++) {
            const FlFluidPart *part = fl_fluid_part(f, c + y * f->stride + x);
            found = part && part->known;
        }
    return found;
}

void fl_fluid_motion(const FlFluid *f, float *motion)
{
    const float px = (float)f->px;
    for (int y = 0; y < f->height; y++)
        for (int x0 = -f->within[0]; x0 < f->width; x0 += f->px) {
            const int i = f->left + (x0 + f->within[0]) / f->px;
            const int j = f->top + (y + f->within[1]) / f->px;
            const bool known = has_fluid(f, j * f->stride + i);
            const float v = ((float)(y + f->within[1]) + .5f) / px - .5f + (float)f->top;
            for (int x = MAX(x0, 0); x < MIN(x0 + f->px, f->width); x++) {
                const float u = ((float)(x + f->within[0]) + .5f) / px - .5f + (float)f->left;
                float *out = motion + 2 * ((size_t)y * (size_t)f->width + (size_t)x);
                for (int k = 0; k < 2; k++)
                    out[k] = known ? px * fl_fluid_sample(f, f->moved[k], u, v) : NAN;
            }
        }
}
