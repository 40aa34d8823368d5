"""Paints vector animations with moving paint: the film object of libfluidy. See fluidy-python(7).

    film = fluidy.Film("walk_%04d.svg", style="05", width=480)
    for frame in film:
        ...                     # a numpy array of height x width x 4, straight sRGBA
    film["tint"] = "#2255aa"    # what was painted stays painted
    film[3]
"""
import struct
import threading
import warnings
import zlib
from typing import Any, Callable, Dict, Iterator, List, NamedTuple, Optional, Sequence, Union

from ._library import (ChangedError, Error, ExistsError, InputError, InterruptedError, LimitError, NoMemoryError,
                       OutputError, StyleError, TimeError, UsageError, chars, check, ffi, library, text)
import numpy

__all__ = ["Film", "Picture", "Progress", "Region", "paint", "ChangedError", "Error", "ExistsError", "InputError",
           "InterruptedError", "LimitError", "NoMemoryError", "OutputError", "StyleError", "TimeError", "UsageError"]
__version__ = text(library.fl_version())


class Picture(numpy.ndarray):
    """A numpy array of height x width x 4 bytes, straight sRGBA, that a notebook shows.

    number: of the frame, as in the name of its file.
    """
    number: Optional[int] = None

    def _repr_png_(self) -> Optional[bytes]:
        if self.ndim != 3 or self.shape[2] != 4 or self.dtype != numpy.uint8:
            return None
        height, width = self.shape[:2]
        rows = numpy.zeros((height, 1 + 4 * width), numpy.uint8)  # each begins with its filter, none
        rows[:, 1:] = self.reshape(height, 4 * width)

        def chunk(kind: bytes, data: bytes) -> bytes:
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

        head = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
        return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows.tobytes())) +
                chunk(b"IEND", b""))


class Region(NamedTuple):
    """A region of the drawing."""
    name: str              # unique; the name in settings
    layer: str             # path of the layers that contain it, with / between
    paint: str             # "#rrggbb", "gradient" or "image"
    style: Optional[str]   # that paints it; None: it is drawn as it is, or left out
    left_out: bool         # it is neither painted nor drawn
    colour: tuple          # in Film.map(): red, green, blue


class Progress(NamedTuple):
    """What a film is doing."""
    stage: str    # "read", "masks", "style", "guides", "lead-in" or "paint"
    region: str   # "": all of them
    done: int     # frames of this stage
    total: int    # 0: not known yet
    share: float  # of the whole, 0 to 1


def _array(pointer: Any, *shape: int) -> Picture:
    """A copy of bytes of the library."""
    data = ffi.buffer(pointer, int(numpy.prod(shape)))
    return numpy.frombuffer(data, numpy.uint8).reshape(shape).copy().view(Picture)


def _name(option: str) -> str:
    return option.replace("_", "-")


def _value(value: Any) -> Optional[str]:
    """The value as on the command line; None: the default."""
    return None if value is None else ("off", "on")[value] if isinstance(value, bool) else str(value)


class Film:
    """A drawing that is painted frame by frame, in any order, while its options change.

    inputs: a pattern, a glob, an SVG file or a folder, or several. config: a file as in
    fluidy-svg.conf(5). progress: called now and then with a Progress; what it raises stops the
    film, and so does False. options: those of fluidy-svg(1), by name, with _ for -.

    A film is a sequence of its frames. Threads may share one: they wait for each other.
    Errors are exceptions of this module, warnings of the library are Python's.
    """

    def __init__(self, inputs: Union[str, Sequence[str]], *, config: Optional[str] = None,
                 progress: Optional[Callable[[Progress], Optional[bool]]] = None, **options: Any):
        words = [chars(path) for path in ([inputs] if isinstance(inputs, str) else inputs)]
        self._lock = threading.RLock()
        self._raised: Optional[BaseException] = None
        self._film = ffi.gc(library.fl_film_open(ffi.new("char *[]", [*words, ffi.NULL])), library.fl_film_close)
        self._calls = ffi.new("FlFilmCalls *", {"size": ffi.sizeof("FlFilmCalls")})
        self._calls.progress = self._on_progress = ffi.callback(
            "bool(FlProgress *, void *)", lambda told, data: self._take_progress(told, progress), error=False,
            onerror=self._keep)
        self._calls.warning = self._on_warning = ffi.callback(
            "void(char *, void *)", lambda message, data: warnings.warn(text(message), stacklevel=4),
            onerror=self._keep)
        library.fl_film_set_calls(self._film, self._calls)
        self._options: Dict[str, Any] = {}  # of all regions, as they were set
        if config is not None:
            self._ask(library.fl_film_set_config, chars(config), ffi.NULL)
        for option, value in options.items():
            self.set(option, value)

    def _take_progress(self, told: Any, progress: Optional[Callable]) -> bool:
        if self._raised:  # by a warning
            return False
        return progress is None or progress(Progress(text(told.stage), text(told.region), told.done, told.total,
                                                     told.share)) is not False

    def _keep(self, kind: Any, raised: BaseException, trace: Any) -> None:
        self._raised = self._raised or raised

    def _ask(self, call: Any, *arguments: Any) -> Any:
        """Calls the library; what a call from there has raised is raised here."""
        with self._lock:
            result = None
            try:
                result = check(call, self._film, *arguments)
            except Error:
                if not self._raised:
                    raise
            raised, self._raised = self._raised, None
        if raised:
            raise raised
        return result

    def set(self, option: str, value: Any, region: Optional[str] = None) -> None:
        """Sets an option of all regions, or of one; None: the default again."""
        with self._lock:
            self._ask(library.fl_film_set, chars(region), chars(_name(option)), chars(_value(value)))
            if region is None:
                self._options[option] = value

    def __setitem__(self, option: str, value: Any) -> None:
        self.set(option, value)

    def _picture(self, call: Any, frame: int, info: Any = library.fl_film_draft_info) -> Picture:
        with self._lock:
            made = self._ask(call, range(self._ask(info).n_frames)[frame])
            picture = _array(made.rgba, made.height, made.width, 4)
            picture.number = made.number
        return picture

    def __getitem__(self, frame: int) -> Picture:
        """Paints a frame: the picture that fluidy-svg makes. Negative ones count from the end."""
        return self._picture(library.fl_film_frame, frame, library.fl_film_info)

    def draft(self, frame: int, side: int = 0) -> Picture:
        """Drafts a frame at once, as if the film began with it. side: px of the longer one at most."""
        with self._lock:
            library.fl_film_set_draft_side(self._film, 2 * side)
            return self._picture(library.fl_film_draft, frame)

    def drawing(self, frame: int) -> Picture:
        """The drawing without paint, as large as drafts are drawn."""
        return self._picture(library.fl_film_drawing, frame)

    def map(self, frame: int) -> Picture:
        """The same with each region in a colour of its own: Region.colour."""
        return self._picture(library.fl_film_map, frame)

    def layers(self, frame: int) -> Dict[str, Picture]:
        """Each painted region alone, on a transparent page, by its name."""
        layers = {}
        with self._lock:
            before = {option: self._options.get(option) for option in ("region", "background")}
            try:
                self.set("background", "none")
                for region in self.regions:
                    if region.style:
                        self.set("region", region.name)
                        layers[region.name] = self[frame]
            finally:
                for option, value in before.items():
                    self.set(option, value)
        return layers

    def _info(self) -> Any:
        with self._lock:
            return ffi.new("FlFilmInfo *", self._ask(library.fl_film_info)[0])

    def __len__(self) -> int:
        return self._info().n_frames

    def __iter__(self) -> Iterator[Picture]:
        return (self[frame] for frame in range(len(self)))

    @property
    def shape(self) -> tuple:
        """Of all frames together: frames, height, width, 4."""
        info = self._info()
        return info.n_frames, info.height, info.width, 4

    @property
    def fps(self) -> float:
        return self._info().fps

    @property
    def regions(self) -> List[Region]:
        """The regions of the drawing."""
        n = ffi.new("int *")
        with self._lock:
            found = self._ask(library.fl_film_regions, n)
            return [Region(text(r.name), text(r.layer), text(r.paint), text(r.style) or None, r.left_out,
                           tuple(r.colour)) for r in found[0:n[0]]]

    @property
    def n_painted(self) -> int:
        """How many pictures of regions were painted so far."""
        with self._lock:
            return library.fl_film_stats(self._film).n_painted

    def render(self) -> None:
        """Writes the film to files, as fluidy-svg does, by the options "output", "layers", …"""
        self._ask(library.fl_film_render)

    def _repr_png_(self) -> Optional[bytes]:
        return self.draft(0, 480)._repr_png_()


def paint(masks: numpy.ndarray, style: str, *, flow: Optional[numpy.ndarray] = None, seed: int = 1,
          **settings: Any) -> List[Picture]:
    """Paints a region that arrays describe; gives a cut-out of it for each frame.

    masks: frames x height x width, 0 outside and 255 inside. flow: frames x height x width x 2
    floats, the motion in px since the frame before, NaN where it is unknown; None: from the masks.
    settings: "tint", "w_temp", … as in fluidy-svg.conf(5).
    """
    masks = numpy.ascontiguousarray(masks, numpy.uint8)
    if masks.ndim != 3 or 0 in masks.shape:
        raise UsageError(f"masks: expected frames x height x width, got {masks.shape}")
    if flow is not None:
        flow = numpy.ascontiguousarray(flow, numpy.float32)
        if flow.shape != (*masks.shape, 2):
            raise UsageError(f"flow: expected {(*masks.shape, 2)}, got {flow.shape}")
    n, height, width = masks.shape
    taken: List[Picture] = []

    def fill(source: numpy.ndarray) -> Callable:
        def give(data: Any, frame: int, out: Any) -> bool:
            ffi.memmove(out, source[frame], source[frame].nbytes)
            return True
        return give

    def take(data: Any, painted: Any) -> bool:
        taken.append(_array(painted.layer, height, width, 4))
        return True

    words = [(ffi.NULL, chars(_name(key)), chars(_value(value)))
             for key, value in {"style": style, **settings}.items() if value is not None]
    listed = ffi.new("FlSetting[]", words)
    mask_call = ffi.callback("bool(void *, int, uint8_t *)", fill(masks))
    flow_call = ffi.NULL if flow is None else ffi.callback("bool(void *, int, float *)", fill(flow))
    take_call = ffi.callback("bool(void *, FlPaintedFrame *)", take)
    region = ffi.new("FlRegionPaint *", {"size": ffi.sizeof("FlRegionPaint"), "width": width, "height": height,
                                         "n_frames": n, "mask": mask_call, "flow": flow_call, "take": take_call,
                                         "settings": listed, "n_settings": len(words), "seed": seed})
    check(library.fl_paint_region, region)
    return taken
