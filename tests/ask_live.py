#!/usr/bin/env python3
"""Asks the server of --serve what it must not answer; speaks lines of "ok - " and "not ok - ".

usage: ask_live.py ADDRESS [flood]
flood: opens more connections than the server has descriptors for, and drops bad.json and good.lottie, nothing else."""
import http.client, json, socket, struct, sys, time, urllib.parse

address = urllib.parse.urlsplit(sys.argv[1])
root, host = address.path, address.netloc
own = {"Origin": f"http://{host}", "Content-Type": "application/x-www-form-urlencoded"}


def ask(method, path, headers={}, **form):
    """The status and the text of an answer."""
    connection = http.client.HTTPConnection(address.hostname, address.port, timeout=20)
    connection.request(method, path, urllib.parse.urlencode(form) if form else None, headers)
    answer = connection.getresponse()
    return answer.status, answer.read().decode()


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
    """A page that takes messages and pictures."""

    def __init__(self):
        self.connection = connect()
        self.file = self.connection.makefile("rb")
        while self.file.readline() != b"\r\n":
            pass

    def message(self):
        """A state or another message, or the six numbers of a picture, which is thanked for."""
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
        self.connection.sendall(bytes([0x81, 0x84]) + b"\0\0\0\0more")
        return struct.unpack("<6I", data[:24])

    def until(self, true):
        while (message := self.message()) is None or not true(message):
            pass
        return message

    def draft(self, generation):
        """The number of a draft of the settings."""
        return self.until(lambda m: isinstance(m, tuple) and m[0] == 1 and m[1] == generation)[2]


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


def choose(headers=own, section="defaults", key="carry", value="0.5"):
    return ask("POST", root + "choice", headers, section=section, key=key, value=value)[0]


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
    tell("a page has pictures after more connections than descriptors", page.until(lambda m: isinstance(m, tuple)))
    status, words = ask("POST", root + "drop?name=bad.json&first=1&last=1", own, x="y")
    tell("an animation without frames is refused with its words", status == 400 and words == "no player\n")
    status = ask("POST", root + "drop?name=good.lottie&first=1&last=1", own, x="y")[0]
    tell("one with frames is shown", status == 200 and page.until(lambda m: "film" in m)["film"]["numbers"] == [7])
    sys.exit()
tell("the page is there", ask("GET", root)[0] == 200 and "inspect" not in ask("GET", root)[1])
tell("its address has a secret", ask("GET", "/")[0] == 404 and ask("GET", "/0000/options")[0] == 404 and len(root) > 30)
tell("a name that leads here from elsewhere is refused", ask("GET", root, {"Host": f"evil.example:{address.port}"})[0] == 403)
tell("so is another port", ask("GET", root, {"Host": "127.0.0.1:1"})[0] == 403)
tell("localhost is a name of its own", ask("GET", root, {"Host": f"localhost:{address.port}"})[0] == 200)
tell("a choice without an origin is refused", choose({"Content-Type": own["Content-Type"]}) == 403)
tell("so is one from another site", choose({**own, "Origin": "http://evil.example"}) == 403)
tell("and a page of another site that reads", ask("GET", root + "options", {"Origin": "null"})[0] == 403)
tell("an output cannot be chosen", choose(section="project", key="output", value="/tmp/x") == 400)
tell("nor an option of the command line alone", choose(section="project", key="dump", value="/tmp/x") == 400)
tell("nor a key that does not exist", choose(key="carri") == 400)
tell("nor a value of two lines", choose(value="1\noutput = x") == 400 and choose(section="region a]\n[project") == 400)
tell("a choice is not read by GET", ask("GET", root + "choice")[0] == 404)
tell("a large body is refused", ask("POST", root + "choice", own, value="x" * 100000)[0] == 413)
tell("a value of the wrong kind is refused with its words", "much" in ask("POST", root + "choice", own, section="defaults",
     key="carry", value="much")[1])
tell("the page sees pictures", "state" in look())
tell("that of another site does not", "state" not in look(Origin="http://evil.example"))
tell("a file that is no drawing is refused", ask("POST", root + "drop?name=a.sh&first=1&last=1", own, x="y")[0] == 400 and
     ask("POST", root + "drop?name=../a.svg&first=1&last=1", own, x="y")[0] == 400)
many = [socket.create_connection((address.hostname, address.port), 20) for _ in range(100)]
end = time.monotonic() + 20
while sum(map(is_open, many)) > 64 and time.monotonic() < end:
    time.sleep(0.05)
few = sum(map(is_open, many)) <= 64
leave(many)
tell("of a hundred connections at most 64 stay open, and the others do no harm", few)
pages = [Page(), Page()]
generations = [page.until(lambda m: "state" in m)["state"]["generation"] for page in pages]
tell("two pages have one state", generations[0] == generations[1])
answer = ask("POST", root + "choice", own, section="defaults", key="tint", value="#123456")[1]
tell("a choice of one is drafted for both", all(page.draft(int(answer)) >= 0 for page in pages))
pages[0].connection.close()
answer = ask("POST", root + "choice", own, section="defaults", key="tint", value="")[1]
tell("one that is left goes on", pages[1].draft(int(answer)) >= 0)
tell("none of them changed the config", ask("GET", root + "config")[1].count("=") == 2)
