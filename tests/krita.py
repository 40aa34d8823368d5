#!/usr/bin/env python3
"""The plug-in for Krita, in a stand-in of what it asks Krita for. usage: krita.py SOURCE STYLE PLUGIN; speaks TAP.

Krita gives each vector layer as an SVG with the page of the image.
"""
import os, sys, types
source, style, plugin = map(os.path.abspath, sys.argv[1:])
sys.path[:0] = [source, plugin]


class Node:
    def __init__(self, kind, name="", shape="", children=(), shown=True):
        self.type, self.name, self.visible = lambda: kind, lambda: name, lambda: shown
        self.childNodes, self.opacity = lambda: list(children), lambda: 255
        self.toSvg = lambda: f'<svg xmlns="http://www.w3.org/2000/svg" width="40" height="30">{shape}</svg>'

    def setColorSpace(self, *words):
        self.colours = words

    def setPixelData(self, data, x, y, width, height):
        self.data, self.size = data, (width, height)


class Document:
    def __init__(self, *layers):
        self.root, self.added = Node("grouplayer", children=layers), []
        self.root.addChildNode = lambda node, above: self.added.append(node)
        self.rootNode, self.width, self.refreshProjection = lambda: self.root, lambda: 40, lambda: None

    def createNode(self, name, kind):
        return Node(kind, name)


krita, widgets = types.ModuleType("krita"), types.ModuleType("PyQt5.QtWidgets")
krita.Extension = type("Extension", (), {"__init__": lambda self, parent: None})
krita.Krita = types.SimpleNamespace(instance=lambda: types.SimpleNamespace(addExtension=lambda extension: None))
for name in ("QApplication QCheckBox QComboBox QDialog QDialogButtonBox QFormLayout QMessageBox QProgressDialog").split():
    setattr(widgets, name, object)
sys.modules.update({"krita": krita, "PyQt5": types.ModuleType("PyQt5"), "PyQt5.QtWidgets": widgets})
import fluidy
import fluidy_paint

count = 0


def tell(sentence, good):
    global count
    count += 1
    print("ok" if good else "not ok", count, "-", sentence, flush=True)


def rect(x, fill):
    """Filled by a gradient of one colour."""
    return (f'<defs><linearGradient id="gradient0"><stop stop-color="{fill}"/></linearGradient></defs>'
            f'<rect id="shape0" x="{x}" y="5" width="20" height="20" fill="url(#gradient0)"/>')


document = Document(Node("paintlayer"), Node("vectorlayer", "low", rect(4, "#cc3322")),
                    Node("grouplayer", children=[Node("vectorlayer", "top", rect(12, "#2255aa"))]),
                    Node("vectorlayer", "hidden", rect(0, "#000000"), shown=False))
told = []
paintings = fluidy_paint.paint(document, style, False, told.append)
fluidy_paint.show(document, paintings, "gouache")
layer = document.added[0]
blue, red = layer.data[4 * (40 * 15 + 20)], layer.data[4 * (40 * 15 + 20) + 2]
tell("visible vector layers are one drawing, each with its own gradients, painted into a layer",
     [p.shape for p in paintings] == [(30, 40, 4)] and layer.size == (40, 30) and blue > red + 40 and
     layer.name() == "painted: gouache" and bool(told))
paintings = fluidy_paint.paint(document, style, True)
tell("or each is a frame", len(paintings) == 2 and int(paintings[0][15, 8, 0]) > int(paintings[0][15, 8, 2]) + 40)
try:
    fluidy_paint.paint(Document(Node("paintlayer")), style, False)
    tell("a document without a vector layer is told", False)
except fluidy.InputError as error:
    tell("a document without a vector layer is told", "no visible vector layer" in str(error))
print(f"1..{count}")
