"""Paints the vector layers of a Krita document: Tools, Scripts, Paint with Fluidy.

Either all visible vector layers are one drawing, whose painting becomes a new layer, or each is a
frame, the lowest first, and the paintings become an animation in a new document's timeline.
"""
import os
import tempfile
import xml.etree.ElementTree as xml

from krita import Extension, Krita
from PyQt5.QtWidgets import (QApplication, QCheckBox, QComboBox, QDialog, QDialogButtonBox, QFormLayout, QMessageBox,
                             QProgressDialog)

import fluidy

SVG = "http://www.w3.org/2000/svg"
SRGB = "sRGB-elle-V2-srgbtrc.icc"
INKSCAPE = "http://www.inkscape.org/namespaces/inkscape"
STYLES = ['watercolour', 'ink', 'bloom', 'charcoal', 'wash', 'two-pigments', 'gouache', 'dry-brush',
          'backruns', 'pastel', 'pools', 'smoke', 'fire', 'billows', 'water']


def vector_layers(node):
    """Visible vector layers below a node, the lowest first."""
    found = []
    for child in node.childNodes():
        if child.visible():
            found += [child] if child.type() == "vectorlayer" else vector_layers(child)
    return found


def one_drawing(layers):
    """An SVG with a group for each layer, which regions take their names from."""
    xml.register_namespace("", SVG)
    xml.register_namespace("inkscape", INKSCAPE)
    page = None
    for n, layer in enumerate(layers):
        root = xml.fromstring(layer.toSvg())
        for element in root.iter():  # Krita counts shapes and gradients anew in each layer
            for name, value in element.attrib.items():
                if name == "id":
                    value = f"layer{n}-{value}"
                elif name.endswith("href") and value.startswith("#"):
                    value = f"#layer{n}-{value[1:]}"
                element.set(name, value.replace("url(#", f"url(#layer{n}-"))
        group = xml.Element(f"{{{SVG}}}g", {f"{{{INKSCAPE}}}groupmode": "layer",
                                            f"{{{INKSCAPE}}}label": layer.name(),
                                            "opacity": str(layer.opacity() / 255)})
        group.extend(root)
        if page is None:
            page = xml.Element(root.tag, root.attrib)
        page.append(group)
    return xml.tostring(page, encoding="unicode")


def write_drawings(document, as_frames, folder):
    """Writes an SVG for each frame. Returns: their paths."""
    layers = vector_layers(document.rootNode())
    if not layers:
        raise fluidy.InputError("The document has no visible vector layer.")
    paths = []
    for n, frame in enumerate([[layer] for layer in layers] if as_frames else [layers]):
        paths.append(os.path.join(folder, f"frame_{n + 1:04}.svg"))
        with open(paths[-1], "w", encoding="utf-8") as file:
            file.write(one_drawing(frame))
    return paths


def paint(document, style, as_frames, progress=None):
    """The paintings, as arrays of height x width x 4, straight sRGBA."""
    with tempfile.TemporaryDirectory() as folder:
        paths = write_drawings(document, as_frames, folder)
        return list(fluidy.Film(paths, style=style, width=document.width(), progress=progress))


def add_layer(document, painting, name):
    """A new layer on top with the painting."""
    layer = document.createNode(name, "paintlayer")
    layer.setColorSpace("RGBA", "U8", SRGB)
    document.rootNode().addChildNode(layer, None)
    height, width = painting.shape[:2]
    layer.setPixelData(painting[:, :, [2, 1, 0, 3]].tobytes(), 0, 0, width, height)
    document.refreshProjection()


def open_animation(document, paintings, name):
    """A new document with the paintings on its timeline."""
    height, width = paintings[0].shape[:2]
    film = Krita.instance().createDocument(width, height, name, "RGBA", "U8", SRGB, document.resolution())
    Krita.instance().activeWindow().addView(film)
    with tempfile.TemporaryDirectory() as folder:
        files = [os.path.join(folder, f"painted_{n:04}.png") for n in range(len(paintings))]
        for file, painting in zip(files, paintings):
            with open(file, "wb") as out:
                out.write(painting._repr_png_())
        film.importAnimation(files, 0, 1)
    film.setFullClipRangeEndTime(len(paintings) - 1)
    return film


def show(document, paintings, style):
    name = f"painted: {style}"
    if len(paintings) == 1:
        add_layer(document, paintings[0], name)
    else:
        open_animation(document, paintings, name)


class FluidyPaint(Extension):
    def setup(self):
        pass

    def createActions(self, window):
        action = window.createAction("fluidy_paint", "Paint with Fluidy…", "tools/scripts")
        action.triggered.connect(self.ask)

    def ask(self):
        document = Krita.instance().activeDocument()
        if document is None:
            return
        dialog = QDialog()
        dialog.setWindowTitle("Paint with Fluidy")
        form = QFormLayout(dialog)
        style, as_frames = QComboBox(), QCheckBox("Each vector layer is a frame, the lowest first")
        style.addItems(STYLES)
        style.setEditable(True)  # numbers and folders as well
        form.addRow("Style", style)
        form.addRow(as_frames)
        buttons = QDialogButtonBox(QDialogButtonBox.Ok | QDialogButtonBox.Cancel)
        buttons.accepted.connect(dialog.accept)
        buttons.rejected.connect(dialog.reject)
        form.addRow(buttons)
        if dialog.exec_() == QDialog.Accepted:
            self.run(document, style.currentText(), as_frames.isChecked())

    def run(self, document, style, as_frames):
        bar = QProgressDialog("Painting…", "Stop", 0, 100)

        def tell(told):
            bar.setValue(int(100 * told.share))
            QApplication.processEvents()
            return not bar.wasCanceled()

        try:
            show(document, paint(document, style, as_frames, tell), style)
        except fluidy.InterruptedError:
            pass
        except (fluidy.Error, OSError) as problem:
            QMessageBox.warning(None, "Paint with Fluidy", str(problem))
        finally:
            bar.close()


Krita.instance().addExtension(FluidyPaint(Krita.instance()))
