#!/usr/bin/env python3
"""Asks the server of --serve what it must not answer; speaks lines of "ok - " and "not ok - ".

usage: ask_live.py ADDRESS [flood|keyed]
keyed: the program was given --style 'ink@1 ./ink@4~2' and a config, which is saved.
flood: opens more connections than the server has descriptors for, and drops bad.json, broken.svg and good.lottie, nothing else."""
import http.client, json, os, socket, struct, sys, time, urllib.parse

address = urllib.parse.urlsplit(sys.argv[1])
root, host = address.path, address.netloc
own = {"Origin": f"http://{host}"}


def ask(method, path, headers={}, body=None):
    """The status and the text of an answer."""
    connection = http.client.HTTPConnection(address.hostname, address.port, timeout=20)
    connection.request(method, path, body, headers)
    answer = connection.getresponse()
    return answer.status, answer.read().decode()


def drop(name, headers=own):
    """The same, after a file of that name was dropped."""
    body = f'--x\r\nContent-Disposition: form-data; name="file"; filename="{name}"\r\n\r\ny\r\n--x--\r\n'
    return ask("POST", root + "drop", {**headers, "Content-Type": "multipart/form-data; boundary=x"}, body)


def connect(**more):
    """A connection that asks for pictures."""
    headers = {"Host": host, "Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13",
               "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==", **more}
    connection = socket.create_connection((address.hostname, address.port), 20)
    lines = [f"GET {root}pictures HTTP/1.1", *[f"{name}: {value}" for name, value in headers.items()], "", ""]
    connection.sendall("\r\n".join(lines).encode())
    return connection


def look(**more):
    """The first bytes that a page gets which asks for pictures."""
    with connect(**more) as connection:
        got = b""
        while b"state" not in got and (more := connection.recv(4096)):
            got += more
        return got.decode(errors="replace")


class Page:
    """A page that says what it wants, and takes messages and pictures."""

    def __init__(self):
        self.connection = connect()
        self.file = self.connection.makefile("rb")
        while self.file.readline() != b"\r\n":
            pass

    def say(self, *parts, kind=1):
        text = "\n".join(map(str, parts)).encode(errors="surrogateescape")
        self.connection.sendall(bytes([0x80 | kind, 0x80 | len(text)]) + b"\0\0\0\0" + text)

    def message(self):
        """A state or another message, or the six numbers of a picture."""
        kind, size = self.file.read(2)
        for short, bytes_ in (126, 2), (127, 8):
            if size == short:
                size = int.from_bytes(self.file.read(bytes_), "big")
                break
        data = self.file.read(size)
        if kind & 15 == 1:
            return json.loads(data)
        if kind & 15 != 2:  # a ping
            return None
        return struct.unpack("<6I", data[:24])

    def until(self, true):
        while (message := self.message()) is None or not true(message):
            pass
        return message

    def state(self):
        return self.until(lambda m: isinstance(m, dict) and "state" in m)["state"]

    def draft(self, generation):
        """The number of a draft of the settings."""
        self.say("paint", generation, 1, 0, 0, "")
        return self.until(lambda m: isinstance(m, tuple) and m[0] == 1 and m[1] == generation)[2]

    def choose(self, section="defaults", key="carry", value="0.5"):
        """Words with which it is refused; "" if it is not."""
        self.say("choose", section, key, value)
        self.say("choose", "end", "end", "")  # is refused as well
        words = ""
        while (message := self.until(lambda m: isinstance(m, dict) and "refused" in m))["key"] != "end":
            words = message["refused"]
        return words


def leave(connections):
    """Closes them, and waits until the server has seen that."""
    for connection in connections:
        connection.close()
    status = 0
    while status != 200:
        try:
            status = ask("GET", root)[0]
        except OSError:
            time.sleep(0.1)


def flood():
    """Opens connections until the server takes no more."""
    many = []
    try:
        while len(many) < 200:
            many.append(socket.create_connection((address.hostname, address.port), 0.3))
    except OSError:
        pass
    leave(many)


def is_open(connection):
    """True if the server has not closed a connection on which no request was sent."""
    connection.setblocking(False)
    try:
        return connection.recv(1) != b""
    except OSError as error:
        return isinstance(error, BlockingIOError)


def tell(sentence, good):
    print(("ok - " if good else "not ok - ") + sentence)


if "flood" in sys.argv:
    flood()
    page = Page()
    generation = page.state()["generation"]
    tell("a page has pictures after more connections than descriptors", page.draft(generation) == 0)
    status = drop("bad.json")[0]
    page.say("paint", page.state()["generation"], 1, 0, 0, "")
    words = page.until(lambda m: "refused" in m)["refused"]
    tell("an animation without frames is refused with its words", status == 200 and words == "no player")
    status = drop("broken.svg")[0]
    page.say("paint", page.state()["generation"], 1, 0, 0, "")
    words = page.until(lambda m: "refused" in m)["refused"]
    tell("a broken drawing is refused by its own name", status == 200 and words.startswith("broken.svg"))
    status = drop("good.lottie")[0]
    page.say("paint", page.state()["generation"], 1, 0, 0, "")
    tell("one with frames is shown", status == 200 and page.until(lambda m: "film" in m)["film"]["numbers"] == [7])
    sys.exit()
page = Page()
if "keyed" in sys.argv:
    ink = os.path.realpath("ink")
    tell("paths of keys are those of any folder", f"style = {ink}@1 {ink}@4~2\n" in page.state()["config"])
    page.say("choose", "defaults", "tint", "#123456")
    page.say("save", 1)
    page.until(lambda m: isinstance(m, dict) and "saved" in m)
    page.say("step", -1)
    page.state()
    with open("film/w_0001.svg", "a") as drawing:
        drawing.write("\n")
    tell("what was saved is taken back for good", "tint" not in page.state()["config"])
    sys.exit()
tell("the page is there", ask("GET", root)[0] == 200 and "inspect" not in ask("GET", root)[1])
tell("its address has a secret", ask("GET", "/")[0] == 404 and ask("GET", "/0000/")[0] == 404 and len(root) > 30)
tell("a name that leads here from elsewhere is refused", ask("GET", root, {"Host": f"evil.example:{address.port}"})[0] == 403)
tell("so is another port", ask("GET", root, {"Host": "127.0.0.1:1"})[0] == 403)
tell("localhost is a name of its own", ask("GET", root, {"Host": f"localhost:{address.port}"})[0] == 200)
tell("a file without an origin is refused", drop("a.svg", {})[0] == 403)
tell("so is one from another site", drop("a.svg", {"Origin": "http://evil.example"})[0] == 403)
tell("and a page of another site that reads", ask("GET", root, {"Origin": "null"})[0] == 403)
tell("an output cannot be chosen", page.choose("project", "output", "/tmp/x"))
tell("nor an option of the command line alone", page.choose("project", "dump", "/tmp/x"))
tell("nor a key that does not exist", page.choose(key="carri"))
tell("nor a value of two lines", page.choose(value="1\noutput = x") and page.choose("region a]\n[project"))
page.say("choose", "defaults", "style", "./\udcff", kind=2)
words = page.until(lambda m: isinstance(m, dict) and "refused" in m)["refused"]
tell("nor anything by bytes that are no text", words.startswith("expected paint"))
tell("nor a section of two", page.choose("region a]\r[project"))
tell("a large body is refused", ask("POST", root, own, "x" * 100000)[0] == 413)
tell("a value of the wrong kind is refused with its words", "much" in page.choose(value="much"))
tell("the page sees pictures", "state" in look())
tell("that of another site does not", "state" not in look(Origin="http://evil.example"))
tell("a file that is no drawing is refused", drop("a.sh")[0] == 400 and drop(".a.svg")[0] == 400)
tell("so is a form without files", ask("POST", root + "drop", own, "x")[0] == 400)
page.connection.close()
many = [socket.create_connection((address.hostname, address.port), 20) for _ in range(100)]
end = time.monotonic() + 20
while sum(map(is_open, many)) > 24 and time.monotonic() < end:
    time.sleep(0.05)
few = sum(map(is_open, many)) <= 24
leave(many)
tell("of a hundred connections at most 24 stay open, and the others do no harm", few)
pages = [Page(), Page()]
states = [page.state() for page in pages]
tell("two pages have one state", states[0] == states[1])
tell("none of them changed the config", states[0]["config"].count("=") == 2)
pages[0].say("choose", "defaults", "tint", "#123456")
generation = pages[1].state()["generation"]
tell("a choice of one is drafted for both", all(page.draft(generation) >= 0 for page in pages))
pages[0].say("step", -1)
state = pages[1].state()
tell("what one has chosen is taken back for both", "tint" not in state["config"] and state["undo"] is None and
     state["redo"] == "tint")
pages[1].say("step", 1)
state = pages[1].state()
tell("and made again", "tint = #123456" in state["config"])
pages[1].draft(state["generation"])
for page, value in zip(pages, ("0.00001", "0.00002")):
    page.say("choose", "defaults", "style-scale", value)
while (state := pages[0].state())["config"].count("0.00002") == 0:
    pass
pages[0].say("paint", state["generation"], 1, 0, 0, "")
refused = pages[0].until(lambda m: isinstance(m, dict) and "refused" in m)
tell("of two choices that fail at once both are taken back, and it is said",
     refused["key"] is None and "the last 2 choices were taken back" in refused["refused"])
pages[0].connection.close()
for k in range(300):
    pages[1].say("choose", "defaults", "carry" if k % 2 else "tint", f"0.{k:03}" if k % 2 else f"#{k:06}")
for k in range(300):
    pages[1].say("step", -1)
pages[1].say("choose", "end", "end", "")
last = {}
while not isinstance(message := pages[1].message(), dict) or message.get("key") != "end":
    last = message.get("state", last) if isinstance(message, dict) else last
tell("256 choices can be taken back, and those before them hold", last["undo"] is None and
     "carry = 0.043\n" in last["config"] and "tint = #000042\n" in last["config"])
pages[1].say("choose", "defaults", "tint", "")
tell("one that is left goes on", pages[1].draft(pages[1].state()["generation"]) >= 0)
