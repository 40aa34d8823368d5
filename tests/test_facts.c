/* A change of anything that a render is made from makes it start anew. */
#include "base/schedule.h"
#include "io/png.h"
#include "io/provenance.h"
#include "job/outputs.h"
#include "job/plan.h"
#include "job/region_plan.h"
#include "option_values.h"
#include "scratch.h"
#include <fcntl.h>
#include <fluidy/render.h>
#include <string.h>
#include <unistd.h>

/* A film of four frames that links to, and is painted with, a file of each kind; and a simple one
 * of the same regions. */
typedef struct Film {
    Scratch *folder;
    char *inputs, *simple, *output, *cache, *style, *ink, *flow, *background, *paper, *config,
        *state;
} Film;

static void copy_file(const char *from, const char *to)
{
    g_autofree char *data = NULL;
    gsize bytes;
    g_assert_true(g_file_get_contents(from, &data, &bytes, NULL));
    scratch_put(to, data, bytes);
}

static void copy_folder(const char *from, const char *to)
{
    g_autoptr(GDir) dir = g_dir_open(from, 0, NULL);
    g_mkdir_with_parents(to, 0777);
    for (const char *name; (name = g_dir_read_name(dir));) {
        g_autofree char *source = g_build_filename(from, name, NULL);
        g_autofree char *target = g_build_filename(to, name, NULL);
        if (g_file_test(source, G_FILE_TEST_IS_DIR))
            copy_folder(source, target);
        else
            copy_file(source, target);
    }
}

/* A part of a picture of 384 x 384 px, which is read sooner. */
static void crop_picture(const char *path)
{
    enum { SIDE = 96 };
    g_autoptr(FlPicture) whole = fl_picture_read_png(path, NULL);
    g_autofree uint8_t *part = g_malloc(4 * SIDE * SIDE);
    g_assert_true(whole && whole->width == 4 * SIDE && whole->height == 4 * SIDE);
    for (int y = 0; y < SIDE; y++)
        memcpy(part + 4 * SIDE * y, whole->rgba + 4 * (4 * SIDE * (y + SIDE) + SIDE), 4 * SIDE);
    g_assert_true(fl_png_write(path, part, SIDE, SIDE, 4, NULL));
}

static void remove_folder(const char *path)
{
    g_autoptr(GDir) dir = g_dir_open(path, 0, NULL);
    for (const char *name; dir && (name = g_dir_read_name(dir));) {
        g_autofree char *inner = g_build_filename(path, name, NULL);
        if (g_unlink(inner) != 0)
            remove_folder(inner);
    }
    g_rmdir(path);
}

static Film film; // one for all tests, since fontconfig reads its configuration once

/* Fonts of the film alone; the system's first one that is there, under another name. */
static void make_fonts(void)
{
    static const char *const fonts[] = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                        "/usr/share/fonts/truetype/noto/NotoSansMono-Regular.ttf"};
    g_autofree char *folder = g_build_filename(film.folder, "fonts", NULL);
    g_autofree char *own = g_build_filename(folder, "own.ttf", NULL);
    g_autofree char *text = g_strdup_printf("<fontconfig><dir>%s</dir></fontconfig>", folder);
    g_autofree char *config = scratch_write(film.folder, "fonts.conf", text);
    for (size_t k = 0; k < G_N_ELEMENTS(fonts); k++) {
        if (!g_file_test(fonts[k], G_FILE_TEST_EXISTS))
            continue;
        g_mkdir_with_parents(folder, 0777);
        copy_file(fonts[k], own);
        g_setenv("FONTCONFIG_FILE", config, TRUE);
        return;
    }
}

/* A small style that moves ink. */
static void make_ink(const char *large)
{
    static const char *const pictures[] = {"transport.png", "frames/0001.png", "masks/0001.png"};
    g_autofree char *ini = g_build_filename(film.ink, "style.ini", NULL);
    copy_folder(large, film.ink);
    g_autofree char *text = NULL;
    g_assert_true(g_file_get_contents(ini, &text, NULL, NULL));
    char *size = strstr(text, "size = 384");
    memcpy(size, "size = 96 ", 10);
    scratch_put(ini, text, strlen(text));
    for (size_t k = 0; k < G_N_ELEMENTS(pictures); k++) {
        g_autofree char *picture = g_build_filename(film.ink, pictures[k], NULL);
        crop_picture(picture);
    }
}

static void film_make(void)
{
    const char *fixtures = g_getenv("FLUIDY_FIXTURES");
    film.folder = scratch_make();
    char **const paths[] = {&film.inputs, &film.simple, &film.output,     &film.cache, &film.style,
                            &film.ink,    &film.flow,   &film.background, &film.paper};
    static const char *const names[] = {"w_%d.svg", "s_%d.svg", "out_%d.png", "cache",    "style",
                                        "ink",      "f_%d.flo", "b_%d.png",   "paper.png"};
    for (size_t k = 0; k < G_N_ELEMENTS(names); k++)
        *paths[k] = g_build_filename(film.folder, names[k], NULL);
    g_autofree char *small = g_build_filename(fixtures, "style-small", NULL);
    g_autofree char *transport = g_build_filename(fixtures, "styles", "11", NULL);
    copy_folder(small, film.style);
    for (int f = 3; f <= 6; f++) { // two frames are read sooner
        g_autofree char *frame = g_strdup_printf("%s/frames/%04d.png", film.style, f);
        g_assert_cmpint(g_unlink(frame), ==, 0);
    }
    make_ink(transport);
    g_free(scratch_write(film.folder, "look.css", "circle { fill: #aa3311 }"));
    g_free(scratch_write(film.folder, "paper.png", "a sheet"));
    g_autofree char *png = g_build_filename(film.folder, "p.png", NULL);
    cairo_surface_t *picture = cairo_image_surface_create(CAIRO_FORMAT_RGB24, 4, 4);
    g_assert_cmpint(cairo_surface_write_to_png(picture, png), ==, CAIRO_STATUS_SUCCESS);
    cairo_surface_destroy(picture);
    for (int f = 1; f <= 4; f += f) { // one is missing
        g_autofree char *name = g_strdup_printf("w_%d.svg", f);
        g_autofree char *simple = g_strdup_printf("s_%d.svg", f);
        g_autofree char *flow = g_strdup_printf("f_%d.flo", f);
        g_autofree char *ground = g_strdup_printf("b_%d.png", f);
        g_free(scratch_svg(film.folder, name,
                           "<style>@import 'look.css';</style><circle cx='50' cy='50' r='30'/>"
                           "<text x='5' y='20' font-family='DejaVu Sans'>Ab</text>"
                           "<image href='p.png' width='9' height='9'/>"));
        if (f != 2)
            g_free(scratch_svg(film.folder, simple,
                               "<circle cx='50' cy='50' r='30' fill='#a31'/>"
                               "<circle cx='50' cy='20' r='9'/>"));
        g_free(scratch_write(film.folder, flow, "a flow"));
        g_free(scratch_write(film.folder, ground, "a ground"));
    }
    film.config = scratch_write(film.folder, "film.conf", "[defaults]\nw-temp = 4\n");
    film.state = g_build_filename(film.folder, ".out_%d.png.state", NULL);
    make_fonts();
}

static void film_clear(void)
{
    remove_folder(film.folder);
    char *const paths[] = {film.inputs, film.simple, film.output, film.cache,
                           film.style,  film.ink,    film.flow,   film.background,
                           film.paper,  film.config, film.state};
    for (size_t k = 0; k < G_N_ELEMENTS(paths); k++)
        g_free(paths[k]);
    g_free(film.folder);
}

static FlPlan *plan_of(const FlRenderOptions *options)
{
    g_autoptr(GError) error = NULL;
    FlPlan *plan = fl_plan_new(options, &error);
    g_assert_no_error(error);
    return plan;
}

static void write_frame(const char *path, FlDigest made_from)
{
    g_autofree char *mark = fl_mark_text(made_from);
    scratch_put(path, mark, strlen(mark));
    const int fd = open(path, O_RDWR | O_CLOEXEC);
    g_assert_true(fl_mark_seal(fd, mark));
    close(fd);
}

/* Leaves a finished render in the store, or an interrupted one in a file, without painting. */
static void leave(const FlRenderOptions *options, bool finished)
{
    g_autoptr(GError) error = NULL;
    FlRenderOptions own = *options;
    own.cache = finished ? options->cache : NULL;
    g_autoptr(FlPlan) plan = plan_of(&own);
    FlResume resume;
    if (plan->finished == FL_FINISHED_ALL)
        return;
    g_assert_true(fl_resume_init(&resume, plan, &error));
    for (int f = 0; f < fl_drawing_frames(plan->shapes.drawing); f++) {
        g_autoptr(GPtrArray) files = fl_frame_files(&plan->out, &plan->shapes, f, NULL);
        g_assert_true(fl_resume_before_files(&resume, plan, f, &error));
        const int number = fl_drawing_number(plan->shapes.drawing, f);
        write_frame(files->pdata[0], fl_mark_of_frame(resume.made_from, number));
        g_assert_true(fl_resume_save(&resume, &error));
    }
    if (finished)
        fl_resume_finish(&resume, plan);
    fl_resume_clear(&resume);
    g_assert_true(g_file_test(film.state, G_FILE_TEST_EXISTS) == !finished);
}

static bool is_finished(const FlRenderOptions *options)
{
    g_autoptr(FlPlan) plan = fl_plan_new(options, NULL);
    return plan && plan->finished == FL_FINISHED_ALL;
}

/* The same without the record and with it. */
static bool is_verified(const FlRenderOptions *options)
{
    FlRenderOptions known = *options, unknown;
    known.verify = true;
    unknown = known;
    unknown.cache = NULL;
    const bool verified = fl_render(&known, NULL);
    g_assert_true(verified == fl_render(&unknown, NULL));
    return verified;
}

static bool is_resumed(const FlRenderOptions *options)
{
    g_autoptr(GError) error = NULL;
    FlRenderOptions careful = *options;
    careful.overwrite = FL_OVERWRITE_REFUSE;
    careful.cache = NULL;
    g_autoptr(FlPlan) plan = fl_plan_new(&careful, NULL);
    FlResume resume = {0};
    const bool found = plan && fl_resume_init(&resume, plan, &error) && resume.found;
    fl_resume_clear(&resume);
    return found;
}

/* The options of the film; settings has room for one more. */
static FlRenderOptions options_of(const char *inputs[2], FlSetting settings[3])
{
    inputs[0] = film.inputs, inputs[1] = NULL;
    settings[0] = (FlSetting){.name = "style", .value = film.style};
    settings[1] = (FlSetting){.region = "black-000000", .name = "style", .value = film.ink};
    return (FlRenderOptions){.size = sizeof(FlRenderOptions),
                             .inputs = inputs,
                             .output = film.output,
                             .cache = film.cache,
                             .flow = film.flow,
                             .background = film.background,
                             .paper = film.paper,
                             .config = film.config,
                             .settings = settings,
                             .n_settings = 2,
                             .missing = FL_MISSING_HOLD,
                             .overwrite = FL_OVERWRITE_YES};
}

/* Those of the simple film, of two files. */
static FlRenderOptions simple_options_of(const char *inputs[2], FlSetting settings[3])
{
    const FlRenderOptions options = options_of(inputs, settings);
    inputs[0] = film.simple;
    return options;
}

/* ---- files ----------------------------------------------------------------------------------- */

static void change(const char *path)
{
    g_autofree char *data = NULL;
    gsize bytes;
    g_assert_true(g_file_get_contents(path, &data, &bytes, NULL));
    g_autoptr(GString) longer = g_string_new_len(data, (gssize)bytes);
    g_string_append_c(longer, '\n');
    scratch_put(path, longer->str, longer->len);
}

static const char *const files[] = {
    "w_1.svg",           "w_4.svg",     "look.css",        "p.png",          "f_2.flo",
    "b_2.png",           "paper.png",   "style/style.ini", "style/frames/*", "ink/style.ini",
    "ink/transport.png", "ink/masks/*", "fonts/own.ttf",
};

/* The first file of a folder, where the name ends in a star. */
static char *path_in(const char *name)
{
    g_autofree char *path = g_build_filename(film.folder, name, NULL);
    if (!g_str_has_suffix(name, "/*"))
        return g_steal_pointer(&path);
    g_autofree char *folder = g_path_get_dirname(path);
    g_autoptr(GDir) dir = g_dir_open(folder, 0, NULL);
    return g_build_filename(folder, g_dir_read_name(dir), NULL);
}

static void a_change_of_any_file_starts_the_render_anew(void)
{
    const char *inputs[2];
    FlSetting settings[3];
    const FlRenderOptions options = options_of(inputs, settings);
    for (size_t k = 0; k < 2 * G_N_ELEMENTS(files); k++) {
        const bool finished = k >= G_N_ELEMENTS(files);
        const char *name = files[k % G_N_ELEMENTS(files)];
        g_autofree char *path = path_in(name), *saved = NULL;
        gsize bytes;
        if (k == 0)
            leave(&options, false);
        if (k == G_N_ELEMENTS(files)) {
            g_assert_true(is_resumed(&options));
            g_unlink(film.state);
            leave(&options, true);
            g_assert_true(is_finished(&options) && is_verified(&options));
        }
        if (!g_file_get_contents(path, &saved, &bytes, NULL)) {
            g_assert_cmpstr(name, ==, "fonts/own.ttf"); // without fonts on this machine
            continue;
        }
        change(path);
        if (finished ? is_finished(&options) || is_verified(&options) : is_resumed(&options))
            g_error("%s although %s has changed", finished ? "has nothing to do" : "resumes", name);
        scratch_put(path, saved, bytes);
    }
    g_assert_true(is_finished(&options) && is_verified(&options));
}

/* A new font may come before those that text was drawn with. */
static void a_change_beside_the_inputs_is_seen(void)
{
    static const char *const added[] = {"style/frames/9999.png", "fonts/new.ttf"};
    const char *inputs[2];
    FlSetting settings[3];
    const FlRenderOptions options = options_of(inputs, settings);
    for (size_t k = 0; k < G_N_ELEMENTS(added); k++) {
        g_autofree char *path = g_build_filename(film.folder, added[k], NULL);
        g_autofree char *folder = g_path_get_dirname(path);
        if (!g_file_test(folder, G_FILE_TEST_IS_DIR))
            continue;
        leave(&options, true);
        g_assert_true(is_finished(&options));
        scratch_put(path, "new", 3);
        g_assert_false(is_finished(&options));
        g_unlink(path);
    }
}

/* The digests of all that decides a film's frames, and the paint of its regions. */
typedef struct Digests {
    FlDigest frames, paint;
} Digests;

static Digests digests_of(const FlRenderOptions *options)
{
    FlRenderOptions own = *options;
    own.cache = NULL;
    g_autoptr(FlPlan) plan = plan_of(&own);
    const FlShapes *shapes = &plan->shapes;
    g_autoptr(FlFacts) frames = fl_plan_facts(plan), guides = fl_plan_facts_of_paint(plan);
    g_autoptr(FlFacts) paint = fl_facts_new();
    for (int p = 0; p < shapes->n_painted; p++) {
        g_autoptr(FlFacts) region = fl_region_facts(shapes, &shapes->painted[p], plan->inputs);
        fl_facts_append(paint, region);
        fl_region_facts_add_flow(paint, shapes, p, plan->inputs);
    }
    fl_facts_append(paint, guides);
    return (Digests){fl_facts_digest(frames), fl_facts_digest(paint)};
}

/* ---- options --------------------------------------------------------------------------------- */

/* What a film alone depends on: the frames stay, and are what it would be made of. */
static bool is_of_film(const FlOption *o)
{
    return strcmp(o->name, "fps") == 0 || strcmp(o->name, "format") == 0 ||
           g_str_has_prefix(o->name, "audio");
}

/* Sets an option of a render or, for all regions, of a region. Returns: false if the command is
 * refused with it. */
static bool set(const FlOption *o, const char *value, FlRenderOptions *options, FlSetting *setting,
                GPtrArray *strings)
{
    g_autoptr(GError) error = NULL;
    if (o->scope == FL_SCOPE_RENDER)
        return fl_option_set(o, value, film.folder, options, strings, &error);
    *setting = (FlSetting){.name = o->name, .value = value};
    options->n_settings++;
    return true;
}

static void check_option(const FlOption *o, FlDigest made_from, GPtrArray *strings)
{
    const char *inputs[2];
    FlSetting settings[3];
    FlRenderOptions options = simple_options_of(inputs, settings);
    g_autofree char *value = option_other_value(o);
    g_autoptr(GError) refused = NULL;
    if (!set(o, value, &options, &settings[2], strings))
        return;
    g_autoptr(FlPlan) plan = fl_plan_new(&options, &refused);
    if (!plan)
        return;
    if (!is_of_film(o) && plan->finished == FL_FINISHED_ALL)
        g_error("has nothing to do although %s is %s", o->name, value);
    if (plan->out.format->film || is_of_film(o))
        return; // a film has no record, and frames do not depend on these options
    g_autoptr(FlFacts) facts = fl_plan_facts(plan);
    if (fl_digest_is_same(fl_facts_digest(facts), made_from))
        g_error("resumes although %s is %s", o->name, value);
}

static void a_change_of_any_option_starts_the_render_anew(void)
{
    const char *inputs[2];
    FlSetting settings[3];
    g_autoptr(GPtrArray) strings = g_ptr_array_new_with_free_func(g_free);
    const FlRenderOptions options = simple_options_of(inputs, settings);
    int n = 0;
    leave(&options, true);
    leave(&options, false); // beside the record of the finished one
    const FlDigest made_from = digests_of(&options).frames;
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *o = fl_option_at(i);
        if (o->scope == FL_SCOPE_PROGRAM || o->bytes == FL_BYTES_NEVER)
            continue;
        check_option(o, made_from, strings);
        n++;
    }
    g_assert_cmpint(n, >, 60);
    g_assert_true(is_finished(&options));
    g_assert_true(is_resumed(&options));
    g_unlink(film.state);
}

/* ---- digests --------------------------------------------------------------------------------- */

static void assert_differ(const char *what, Digests a, Digests b, bool paint)
{
    if (fl_digest_is_same(a.frames, b.frames))
        g_error("%s is no fact of the frames", what);
    if (paint && fl_digest_is_same(a.paint, b.paint))
        g_error("%s is no fact of the paint", what);
}

static void assert_file_counts(const FlRenderOptions *options, Digests before, const char *name,
                               bool paint)
{
    g_autofree char *path = path_in(name), *saved = NULL;
    gsize bytes;
    g_assert_true(g_file_get_contents(path, &saved, &bytes, NULL));
    change(path);
    assert_differ(name, before, digests_of(options), paint);
    scratch_put(path, saved, bytes);
}

static void files_count_for_frames_and_paint(void)
{
    static const char *const of_paint[] = {"p.png", "f_2.flo", "style/style.ini",
                                           "ink/transport.png"};
    const char *inputs[2];
    FlSetting settings[3];
    FlRenderOptions options = options_of(inputs, settings);
    g_free(scratch_write(film.folder, "hand.png", "directions"));
    g_free(scratch_write(film.folder, "kept_1.png", "paint"));
    g_autofree char *hand = path_in("hand.png"), *kept = path_in("kept_%d.png");
    options.directions = hand;
    Digests before = digests_of(&options);
    for (size_t k = 0; k < G_N_ELEMENTS(of_paint); k++)
        assert_file_counts(&options, before, of_paint[k], true);
    assert_file_counts(&options, before, "hand.png", false);
    options.frames = "4"; // which begins on the paper that the frames before it have wetted
    before = digests_of(&options);
    assert_file_counts(&options, before, "w_2.svg", false);
    options.frames = NULL, options.merge = true, options.paint = kept;
    options.only_region = "red-aa3311";
    before = digests_of(&options);
    assert_file_counts(&options, before, "kept_1.png", false);
}

/* Of two configs and settings the paint of the first region differs. */
static void settings_count_for_frames_and_paint(void)
{
    g_autofree char *keyed = g_strdup_printf("%s@1 %s@3", film.style, film.style);
    g_autofree char *later = g_strdup_printf("%s@1 %s@4", film.style, film.style);
    const struct {
        const char *config[2], *name, *value[2];
    } cases[] = {
        {{"", ""}, "style", {keyed, later}},
        {{"", ""}, "hold", {"1", "2"}},
        {{"", ""}, "w-temp", {"1", "2"}},
        {{"[defaults]\nhold = 1\n[region red-aa3311]\nhold = 1",
          "[defaults]\nhold = 2\n[region red-aa3311]\nhold = 1"},
         "w-temp",
         {"1", "1"}},
        {{"", "[region black-000000]\nedges = soft"}, "w-temp", {"1", "1"}},
        {{"[region red-aa3311]\nmatch-fill = #aa3311;#000000",
          "[region red-aa3311]\nmatch-fill = #aa3311;image"},
         "w-temp",
         {"1", "1"}},
    };
    for (size_t k = 0; k < G_N_ELEMENTS(cases); k++) {
        Digests digests[2];
        for (int i = 0; i < 2; i++) {
            const char *inputs[2];
            FlSetting settings[3];
            FlRenderOptions options = simple_options_of(inputs, settings);
            settings[1] = (FlSetting){.name = cases[k].name, .value = cases[k].value[i]};
            options.config_text = cases[k].config[i];
            digests[i] = digests_of(&options);
        }
        g_autofree char *what = g_strdup_printf("%s %s", cases[k].name, cases[k].config[1]);
        assert_differ(what, digests[0], digests[1], true);
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    (void)fl_schedule_set_threads(1); // a worker for each thread is started by every plan
    film_make();
    g_test_add_func("/facts/a-change-of-any-file-starts-the-render-anew",
                    a_change_of_any_file_starts_the_render_anew);
    g_test_add_func("/facts/a-change-beside-the-inputs-is-seen",
                    a_change_beside_the_inputs_is_seen);
    g_test_add_func("/facts/a-change-of-any-option-starts-the-render-anew",
                    a_change_of_any_option_starts_the_render_anew);
    g_test_add_func("/facts/files-count-for-frames-and-paint", files_count_for_frames_and_paint);
    g_test_add_func("/facts/settings-count-for-frames-and-paint",
                    settings_count_for_frames_and_paint);
    const int status = g_test_run();
    film_clear();
    return status;
}
