#!/usr/bin/env python3
"""Asks the server of --serve what it must not answer; speaks lines of "ok - " and "not ok - ".

usage: ask_live.py ADDRESS"""
import http.client, sys, urllib.parse

address = urllib.parse.urlsplit(sys.argv[1])
root, host = address.path, address.netloc
own = {"Origin": f"http://{host}", "Content-Type": "application/x-www-form-urlencoded"}


def ask(method, path, headers={}, **form):
    """The status and the text of an answer."""
    connection = http.client.HTTPConnection(address.hostname, address.port, timeout=20)
    connection.request(method, path, urllib.parse.urlencode(form) if form else None, headers)
    answer = connection.getresponse()
    return answer.status, answer.read().decode()


def choose(headers=own, section="defaults", key="carry", value="0.5"):
    return ask("POST", root + "choice", headers, section=section, key=key, value=value)[0]


def tell(sentence, good):
    print(("ok - " if good else "not ok - ") + sentence)


tell("the page is there", ask("GET", root)[0] == 200 and "inspect" not in ask("GET", root)[1])
tell("its address has a secret", ask("GET", "/")[0] == 404 and ask("GET", "/0000/state")[0] == 404 and len(root) > 30)
tell("a name that leads here from elsewhere is refused", ask("GET", root, {"Host": f"evil.example:{address.port}"})[0] == 403)
tell("so is another port", ask("GET", root, {"Host": "127.0.0.1:1"})[0] == 403)
tell("localhost is a name of its own", ask("GET", root, {"Host": f"localhost:{address.port}"})[0] == 200)
tell("a choice without an origin is refused", choose({"Content-Type": own["Content-Type"]}) == 403)
tell("so is one from another site", choose({**own, "Origin": "http://evil.example"}) == 403)
tell("and a page of another site that reads", ask("GET", root + "state", {"Origin": "null"})[0] == 403)
tell("an output cannot be chosen", choose(section="project", key="output", value="/tmp/x") == 400)
tell("nor an option of the command line alone", choose(section="project", key="dump", value="/tmp/x") == 400)
tell("nor a key that does not exist", choose(key="carri") == 400)
tell("nor a value of two lines", choose(value="1\noutput = x") == 400 and choose(section="region a]\n[project") == 400)
tell("a choice is not read by GET", ask("GET", root + "choice")[0] == 404)
tell("a large body is refused", ask("POST", root + "choice", own, value="x" * 100000)[0] == 413)
tell("none of them changed the config", ask("GET", root + "config")[1].count("=") == 2)
