#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""test_serve.py PROGRAMS SOURCES: what kiln serve answers, and what it must not.

Requests go over sockets as they are, since a client library would tidy up their paths.
"""
import json, os, pathlib, re, shutil, signal, socket, subprocess, sys, tempfile, time

programs, sources = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
faults = []


def expect(what, found, expected):
    if found != expected:
        faults.append(f"{what}: found {found!r}; expected {expected!r}")


def ask(port, path, method="GET", host=None, more="", address="127.0.0.1"):
    """Returns status, headers by their names in small letters, and body."""
    with socket.create_connection((address, port), timeout=10) as connection:
        host = f"127.0.0.1:{port}" if host is None else host
        head = f"{method} {path} HTTP/1.1\r\n" + (f"Host: {host}\r\n" if host else "") + f"Connection: close\r\n{more}\r\n"
        connection.sendall(head.encode("latin-1"))
        answer = b""
        while part := connection.recv(65536):
            answer += part
    head, _, body = answer.partition(b"\r\n\r\n")
    lines = head.decode("latin-1").split("\r\n")
    return int(lines[0].split()[1]), {k.lower(): v.strip() for k, v in (line.split(":", 1) for line in lines[1:])}, body


def serve(*words):
    program = subprocess.Popen([programs / "kiln", "serve", *words, "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               text=True)
    line = program.stdout.readline()
    if not line:
        sys.exit(f"kiln serve ended: {program.stderr.read()}")
    return program, json.loads(line)


with tempfile.TemporaryDirectory() as outer:
    outer = pathlib.Path(outer)
    (outer / "secret.txt").write_text("secret")
    folder = outer / "assets"
    asset = folder / "bunny" / "prt"
    shutil.copytree(sources / "examples" / "post", asset)
    shutil.copytree(asset, folder / "bunny" / "prt2" / "deeper")
    shutil.copytree(asset, folder / ".hidden" / "prt")
    shutil.copytree(asset, folder / "bäume 100%" / "prt")
    subprocess.run([programs / "kiln-export", asset, "-o", folder / "post.glb", "--quiet"], check=True)
    (folder / "other.glb").write_bytes((folder / "post.glb").read_bytes().replace(b"KILN_prt", b"ANY_thin"))
    (folder / ".key").write_text("secret")
    (folder / "out.txt").symlink_to(outer / "secret.txt")
    (folder / "up").symlink_to(outer)
    (folder / "dotted.txt").symlink_to(folder / ".key")
    (folder / "inside.json").symlink_to("bunny/prt/ranges.json")
    os.mkfifo(folder / "pipe.json")

    program, told = serve(folder)
    try:
        port = told["port"]
        expect("address", told["address"], f"http://127.0.0.1:{port}/")
        expect("number of assets", told["assets"], 4)

        # The page, and what is beside it.
        status, headers, body = ask(port, "/")
        expect("the page", status, 200)
        expect("the page, a page", b"<!doctype html" in body.lower(), True)
        expect("its type", headers["content-type"], "text/html; charset=utf-8")
        expect("by its name", ask(port, "/index.html")[2], body)
        built = sources / "tools" / "web" / "dist"
        for file in (one for one in built.rglob("*") if one.is_file() and one.name != "kiln-report.js"):  # for reports
            expect(f"{file.name}, byte for byte", ask(port, "/" + file.relative_to(built).as_posix())[2] == file.read_bytes(), True)
        listed = json.loads(ask(port, "/assets.json")[2])
        expect("assets", listed, {"assets": [{"name": "bunny", "path": "bunny/prt"}, {"name": "bunny/prt2/deeper", "path": "bunny/prt2/deeper"},
                                             {"name": "bäume 100%", "path": "b%C3%A4ume%20100%25/prt"}, {"name": "post.glb", "path": "post.glb"}]})
        for name in ("script", "default", "object", "frame-ancestors"):
            policy = headers["content-security-policy"]
            expect(f"policy of {name}", bool(re.search(r"\*|https?:|'unsafe-eval'|script-src[^;]*'unsafe-inline'", policy)), False)
        for name, value in {"x-content-type-options": "nosniff", "cross-origin-resource-policy": "same-origin"}.items():
            expect(name, headers.get(name), value)

        # Files of the folder, with their types, whole and unchanged.
        for path, kind in {"/bunny/prt/ranges.json": "application/json", "/bunny/prt/coeff_0_00.png": "image/png",
                           "/bunny/prt/atlas.drc": "application/octet-stream", "/post.glb": "model/gltf-binary",
                           "/b%C3%A4ume%20100%25/prt/ranges.json": "application/json", "/inside.json": "application/json"}.items():
            status, headers, body = ask(port, path)
            expect(path, (status, headers["content-type"]), (200, kind))
            expect(f"{path}, nosniff", headers.get("x-content-type-options"), "nosniff")
        expect("bytes", ask(port, "/post.glb")[2], (folder / "post.glb").read_bytes())
        status, headers, body = ask(port, "/post.glb", "HEAD")
        expect("HEAD", (status, int(headers["content-length"]), body), (200, (folder / "post.glb").stat().st_size, b""))
        expect("a new asset", len(listed["assets"]), 4)
        shutil.copytree(asset, folder / "new" / "prt")
        expect("an asset that came later", len(json.loads(ask(port, "/assets.json")[2])["assets"]), 5)

        # What is outside, hidden, no file, or not there.
        for path in ("/../secret.txt", "/bunny/../../secret.txt", "/%2e%2e/secret.txt", "/%2e%2e%2fsecret.txt", "/..%2fsecret.txt",
                     "/bunny/..%2f..%2fsecret.txt", "/..\\secret.txt", "/%252e%252e/secret.txt", f"/{outer}/secret.txt", f"//{outer}/secret.txt",
                     "/out.txt", "/up/secret.txt", "/.key", "/%2ekey", "/dotted.txt", "/.hidden/prt/ranges.json",
                     "/bunny", "/bunny/", "/bunny/prt", "/pipe.json", "/etc/passwd", "/nothing.png", "/bunny/prt/ranges.json%00.png",
                     "/bunny/prt/./ranges.json", "/" + "a/" * 2000 + "b", "/" + "a" * 300):
            status, headers, body = ask(port, path)
            expect(f"refused: {path[:60]}", (status in (400, 404, 414), b"secret" in body), (True, False))

        # Names that somebody has pointed at this machine, and none at all.
        for host in ("evil.example", f"evil.example:{port}", f"127.0.0.1.evil.example:{port}", f"localhost.evil.example:{port}", "localhost",
                     f"127.0.0.1:{port + 1}", f"localhost:{port}@evil.example", "", f"0.0.0.0:{port}"):
            expect(f"host {host}", ask(port, "/assets.json", host=host)[0], 403)
        expect("host localhost", ask(port, "/assets.json", host=f"localhost:{port}")[0], 200)

        # Read only.
        for method in ("POST", "PUT", "DELETE", "OPTIONS", "PATCH"):
            status, headers, _ = ask(port, "/bunny/prt/ranges.json", method, more="Content-Length: 0\r\n")
            expect(method, status, 405)
        expect("still there", (asset / "ranges.json").exists(), True)

        # Loopback alone: the machine's own address, where it has one, is not answered.
        own = subprocess.run(["hostname", "-I"], capture_output=True, text=True).stdout.split()
        for address in [one for one in own if ":" not in one][:1] + ["127.0.0.2"]:
            try:
                ask(port, "/", address=address)
                faults.append(f"{address} is answered")
            except OSError:
                pass

        # The port is taken: a second server says so.
        second = subprocess.run([programs / "kiln-serve", folder, "--port", str(port)], capture_output=True, text=True, timeout=30)
        expect("a port that is taken", (second.returncode, str(port) in second.stderr, "--port" in second.stderr), (5, True, True))
    finally:
        program.send_signal(signal.SIGTERM)
        began = time.monotonic()
        expect("the end by SIGTERM", program.wait(timeout=30), -signal.SIGTERM)
        expect("within seconds", time.monotonic() - began < 5, True)

    # The port is free again at once; Ctrl-C ends it, too; the folder may be without assets.
    program, told = serve(outer / "assets" / "bunny" / "prt", "--port", str(port))
    expect("one asset", told["assets"], 1)
    expect("its list", json.loads(ask(port, "/assets.json")[2]), {"assets": [{"name": "bunny", "path": "."}]})
    program.send_signal(signal.SIGINT)
    expect("the end by SIGINT", program.wait(timeout=30), -signal.SIGINT)

print("\n".join(faults) if faults else "kiln serve answers what it should and nothing else")
sys.exit(bool(faults))
