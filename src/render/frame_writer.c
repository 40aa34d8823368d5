#include "render/frame_writer.h"

#include "base/error.h"
#include "io/pattern.h"
#include "io/png.h"
#include "io/provenance.h"
#include "io/sink.h"
#include "job/outputs.h"

#define SHEET "paper_sheet" // region names have no underscore
#define GROUND "paper_ground"

static char *mark_of(const FlFrameWriter *writer, int frame)
{
    const int number = fl_drawing_number(writer->shapes->drawing, frame);
    return fl_mark_text(fl_mark_of_frame(writer->resume->made_from, number));
}

/* Writes a layer in the whole frame's size, so that any program can stack them. */
static bool write_layer(const FlFrameWriter *writer, FlPng png, const char *name, int frame,
                        GError **error)
{
    const FlShapes *shapes = writer->shapes;
    const int number = fl_drawing_number(shapes->drawing, frame);
    g_autofree char *mark = mark_of(writer, frame);
    png.width = shapes->page_width, png.height = shapes->page_height;
    png.mark = mark;
    g_autofree char *path = fl_output_name(writer->out->layers, number, name, error);
    return path && (fl_resume_keeps(writer->resume, path) ||
                    fl_png_save(&png, path, fl_resume_replaces(writer->resume, frame), error));
}

/* Each file is a wait for the disk, which one thread leaves to another. */
static bool write_layers(const FlFrameWriter *writer, const FlComposite *composite, int frame,
                         GError **error)
{
    GError *first = NULL;
#pragma omp parallel for schedule(dynamic)
    for (int k = 0; k < composite->n_layers; k++) {
        const FlLayer *layer = &composite->layers[k];
        GError *failure = NULL;
        if (!write_layer(writer, (FlPng){.runs = &layer->runs, .filled = &layer->area.box},
                         composite->names[k], frame, &failure))
            fl_parallel_error_keep(&first, failure);
    }
    if (!fl_parallel_error_propagate(error, first))
        return false;
    return !composite->sheet || fl_paper_sheet_since(writer->paper, frame) != frame ||
           write_layer(writer, (FlPng){.rgba = composite->sheet}, SHEET, frame, error);
}

bool fl_frame_writer_paint(const FlFrameWriter *writer, const FlPaintedRegion *const *painted,
                           int frame, GError **error)
{
    const FlOutputs *o = writer->out;
    g_autofree char *mark = mark_of(writer, frame);
    for (int p = 0; o->paint && !o->merge && p < writer->shapes->n_painted; p++) {
        const FlRegionPlan *region = &writer->shapes->painted[p];
        g_autofree char *path =
            fl_paint_file_name(o->paint, writer->shapes->drawing, region, frame, error);
        if (!path)
            return false;
        if (frame % region->settings.hold == 0 && !fl_resume_keeps(writer->resume, path) &&
            !fl_paint_file_save(painted[p], o->paint_area, path, mark,
                                fl_resume_replaces(writer->resume, frame), error))
            return false;
    }
    return true;
}

/* Background, layers and paper, bottom first. Returns: how many. */
static int stack_layers(const FlFrameWriter *writer, const FlComposite *composite, int frame,
                        FlSinkLayer *layers)
{
    const int width = writer->shapes->page_width, height = writer->shapes->page_height;
    int n = 0;
    if (composite->ground)
        layers[n++] = (FlSinkLayer){
            .name = GROUND, .width = width, .height = height, .rgba = composite->ground};
    for (int k = 0; k < composite->n_layers; k++) {
        const FlLayer *from = &composite->layers[k];
        const FlRect box = from->area.box;
        layers[n++] = (FlSinkLayer){.name = composite->names[k],
                                    .region = composite->regions[k],
                                    .x = box.x,
                                    .y = box.y,
                                    .width = box.width,
                                    .height = box.height,
                                    .runs = &from->runs};
    }
    if (composite->sheet && composite->ground) // frames without a background are not multiplied
        layers[n++] = (FlSinkLayer){.name = SHEET,
                                    .width = width,
                                    .height = height,
                                    .rgba = composite->sheet,
                                    .since = 1 + fl_paper_sheet_since(writer->paper, frame),
                                    .multiply = true};
    return n;
}

bool fl_frame_writer_frame(FlFrameWriter *writer, const FlComposite *composite, int frame,
                           GError **error)
{
    g_autofree FlSinkLayer *layers = g_new0(FlSinkLayer, composite->n_layers + 2);
    const int n_layers = stack_layers(writer, composite, frame, layers);
    const FlSinkFrame out = {.number = fl_drawing_number(writer->shapes->drawing, frame),
                             .rgba = composite->rgba,
                             .rgba16 = composite->rgba16,
                             .layers = layers,
                             .n_layers = n_layers,
                             .vectors = composite->vectors,
                             .thickness = writer->out->thickness};
    if (writer->out->layers && !write_layers(writer, composite, frame, error))
        return false;
    if (writer->sink->format->film)
        return fl_sink_frame(writer->sink, &out, error);
    g_autofree char *file = fl_sink_file(&writer->sink->params, out.number, error);
    writer->sink->params.overwrite = fl_resume_replaces(writer->resume, frame);
    return file &&
           (fl_resume_keeps(writer->resume, file) || fl_sink_frame(writer->sink, &out, error)) &&
           (!writer->movie || fl_sink_frame(writer->movie, &out, error));
}

/* Copies the finished frames of a resumed render into the film. */
static bool copy_finished_frames(FlFrameWriter *writer, GError **error)
{
    for (int f = 0; writer->movie && f < writer->resume->first; f++) {
        const int number = fl_drawing_number(writer->shapes->drawing, f);
        g_autofree char *file = fl_sink_file(&writer->sink->params, number, error);
        g_autoptr(FlPicture) picture = file ? fl_picture_read_png(file, error) : NULL;
        if (!picture)
            return false;
        const FlSinkFrame out = {.number = number, .rgba = picture->rgba};
        if (picture->width != writer->movie->params.width ||
            picture->height != writer->movie->params.height)
            return fl_fail(
                error, FL_ERROR_CHANGED,
                "%s: %dx%d pixels, but an earlier run painted %dx%d; use ‘overwrite’ to start anew",
                file, picture->width, picture->height, writer->movie->params.width,
                writer->movie->params.height);
        if (!fl_sink_frame(writer->movie, &out, error))
            return false;
    }
    return true;
}

bool fl_frame_writer_init(FlFrameWriter *writer, const FlOutputs *out, const FlShapes *shapes,
                          const FlResume *resume, bool opaque, FlStop stop, FlFrameTaker taker,
                          GError **error)
{
    *writer = (FlFrameWriter){.out = out, .shapes = shapes, .resume = resume};
    const FlDigest of_film = fl_film_digest(out, resume->made_from);
    FlSinkParams params = {.path = out->output,
                           .made_from = out->format->film ? of_film : resume->made_from,
                           .width = shapes->page_width,
                           .height = shapes->page_height,
                           .fps = out->fps,
                           .audio = out->audio,
                           .audio_from = out->audio_from,
                           .seconds = (out->end - out->first) / out->fps,
                           .opaque = opaque,
                           .patience = {.stopped = stop.asked, .data = stop.data},
                           .taker = taker,
                           .fast = shapes->width < shapes->page_width, // drafts are not kept
                           .overwrite = out->overwrite == FL_OVERWRITE_YES};
    writer->sink = fl_sink_open(taker.take ? &fl_sink_taken : out->format, &params, error);
    if (!writer->sink || !out->movie)
        return writer->sink != NULL;
    params.path = out->movie, params.made_from = of_film;
    writer->movie = fl_sink_open(out->movie_format, &params, error);
    return writer->movie && copy_finished_frames(writer, error);
}

bool fl_frame_writer_finish(FlFrameWriter *writer, GError **error)
{
    return fl_sink_finish(writer->sink, error) &&
           (!writer->movie || fl_sink_finish(writer->movie, error));
}

void fl_frame_writer_clear(FlFrameWriter *writer)
{
    fl_sink_free(writer->sink);
    fl_sink_free(writer->movie);
    *writer = (FlFrameWriter){0};
}
