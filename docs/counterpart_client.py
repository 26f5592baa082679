#!/usr/bin/env python3
"""A client for the Counterpart protocol, version 1: one file, the standard library alone.

Written from docs/protocol.md. As a program it prints what a tracker or renderer says, one JSON object a line:

    python3 counterpart_client.py 127.0.0.1:7401 --seconds 10
    python3 counterpart_client.py 127.0.0.1:7402 --send '{"id": 1, "verb": "say", "text": "Good evening"}'

As a module:

    with Client("127.0.0.1:7402", role="director") as client:
        client.send("command", {"id": 1, "verb": "say", "text": "Good evening"})
        for name, body in client.messages(seconds=10):
            print(name, body)
"""
import argparse
import hashlib
import hmac
import json
import os
import selectors
import socket
import ssl
import struct
import sys
import time

HEADER = struct.Struct("<4sHBBIIQQQq")
TYPES = {1: "hello", 2: "welcome", 3: "heartbeat", 4: "error", 5: "bye", 6: "clock_request", 7: "clock_response",
         8: "acknowledge", 9: "challenge", 10: "proof", 16: "intrinsics", 17: "pose", 18: "video", 19: "mask", 20: "debug",
         21: "frame_done", 32: "board_state", 33: "game_event", 34: "control", 35: "scene", 48: "command", 49: "feedback"}
NUMBERS = {name: number for number, name in TYPES.items()}
KEPT = {"intrinsics", "frame_done", "board_state", "game_event", "control", "scene", "command", "feedback"}
FIXED = {"heartbeat", "clock_request", "clock_response", "acknowledge", "pose", "video", "mask", "frame_done"}
STATUS = {1: "ok", 2: "coasting", 3: "lost", 4: "relocalised"}
CODECS = {1: "raw_bgr8", 2: "jpeg", 3: "h264"}


class ProtocolError(Exception):
    """The peer broke the rules, refused us or went away."""


def _table():
    table = []
    for byte in range(256):
        crc = byte
        for _ in range(8):
            crc = (crc >> 1) ^ (0x82F63B78 if crc & 1 else 0)
        table.append(crc)
    return table


_CRC = _table()


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc = (crc >> 8) ^ _CRC[(crc ^ byte) & 0xFF]
    return crc ^ 0xFFFFFFFF


def limit(number):
    return 16 << 20 if number == 18 else 1 << 20 if number in (19, 20) else 64 << 10


def pack(name, body, session=0, seq=0, frame_id=0):
    """One whole message. Body: bytes, or what becomes JSON."""
    data = body if isinstance(body, bytes) else json.dumps(body).encode()
    now = time.monotonic_ns()
    head = HEADER.pack(b"VHP1", NUMBERS[name], 1, 1 if seq else 0, len(data), 0, session, seq, frame_id, now)
    crc = crc32c(head[:12] + head[16:] + data)
    return head[:12] + struct.pack("<I", crc) + head[16:] + data


def _stamp(body):
    frame_id, capture_ns = struct.unpack_from("<Qq", body)
    return {"frame_id": frame_id, "capture_ns": capture_ns}


def unpack_body(name, body):
    """The body as a dict; pictures and runs keep their bytes under "data" and "runs"."""
    if name not in FIXED:
        return json.loads(body)
    if name == "heartbeat":
        queued, _, dropped = struct.unpack_from("<IIQ", body)
        return {"queued": queued, "dropped": dropped}
    if name == "clock_request":
        return {"sent_ns": struct.unpack_from("<q", body)[0]}
    if name == "clock_response":
        return dict(zip(("sent_ns", "received_ns", "answered_ns"), struct.unpack_from("<qqq", body)))
    if name == "acknowledge":
        return {"seq": struct.unpack_from("<Q", body)[0]}
    out = _stamp(body)
    if name == "pose":
        object_id, intrinsics_id, status, rms, share, _ = struct.unpack_from("<IIB3xffI", body, 16)
        numbers = struct.unpack_from("<7d21f", body, 40)
        out.update(object_id=object_id, intrinsics_id=intrinsics_id, status=STATUS[status], rms_px=rms, seen_share=share,
                   q=numbers[:4], p=numbers[4:7], covariance=numbers[7:])
    elif name == "video":
        codec, width, height, _, stride, size = struct.unpack_from("<HHHHII", body, 16)
        out.update(codec=CODECS[codec], width=width, height=height, stride=stride, size=size, data=body[32:32 + size])
    elif name == "mask":
        width, height, count = struct.unpack_from("<HHI", body, 16)
        out.update(width=width, height=height, runs=struct.unpack_from(f"<{count}I", body, 24))
    return out


class Lane:
    """One connection of a session."""

    def __init__(self, address, hello, token=None, tls_file=None):
        host, port = address.rsplit(":", 1)
        self.socket = socket.create_connection((host.strip("[]"), int(port)), timeout=3)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        if tls_file:
            tls = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
            tls.minimum_version = ssl.TLSVersion.TLSv1_3
            tls.check_hostname = False  # the authority signs for this installation alone
            tls.load_cert_chain(tls_file)
            tls.load_verify_locations(tls_file)
            self.socket = tls.wrap_socket(self.socket)
        self.buffer = bytearray()
        self.session = 0
        self.received = hello["last_seq"]  # the last kept message that came
        self.next_beat = time.monotonic() + 0.5
        self.last_heard = time.monotonic()
        self._open(hello, token)
        self.socket.setblocking(False)

    def _open(self, hello, token):
        hello_body = json.dumps(hello).encode()
        self.write("hello", hello_body)
        nonce, server_nonce, proved = os.urandom(32), b"", token is None
        while True:
            name, body, _ = self._wait_one()
            body = unpack_body(name, body)
            if name == "error":
                raise ProtocolError(body["message"])
            if name == "challenge":
                if token is None:
                    raise ProtocolError("the peer asks for a token")
                server_nonce = bytes.fromhex(body["nonce"])
                mac = self._mac(token, b"client", server_nonce, nonce, hello_body)
                self.write("proof", {"nonce": nonce.hex(), "mac": mac})
            elif name == "proof":
                proved = token is not None and hmac.compare_digest(
                    body["mac"], self._mac(token, b"server", server_nonce, nonce, hello_body))
            elif name == "welcome":
                if not proved:
                    raise ProtocolError("the peer did not prove that it knows the token")
                self.welcome, self.session = body, body["session"]
                return
            else:
                raise ProtocolError(f"{name} came where WELCOME was expected")

    @staticmethod
    def _mac(token, who, server_nonce, client_nonce, hello_body):
        text = b"counterpart 1 " + who + server_nonce + client_nonce + hello_body
        return hmac.new(token, text, hashlib.sha256).hexdigest()

    def write(self, name, body, seq=0):
        data = pack(name, body, self.session, seq)
        while data:
            try:
                data = data[self.socket.send(data):]
            except (BlockingIOError, ssl.SSLWantWriteError):
                time.sleep(0.001)

    def _wait_one(self):
        while True:
            message = self.take()
            if message:
                return message
            data = self.socket.recv(65536)
            if not data:
                raise ProtocolError("the peer closed the connection")
            self.buffer += data

    def take(self):
        """The next whole message in the buffer as (name, body, seq), or None."""
        if len(self.buffer) < HEADER.size:
            return None
        magic, number, _, flags, length, crc, _, seq, _, _ = HEADER.unpack_from(self.buffer)
        if magic != b"VHP1" or length > limit(number):
            raise ProtocolError("not a message of this protocol")
        if len(self.buffer) < HEADER.size + length:
            return None
        message = bytes(self.buffer[:HEADER.size + length])
        del self.buffer[:HEADER.size + length]
        if crc32c(message[:12] + message[16:]) != crc:
            raise ProtocolError("the checksum of a message does not match")
        return TYPES.get(number), message[HEADER.size:], seq if flags & 1 else 0

    def read(self):
        while True:
            try:
                data = self.socket.recv(262144)
            except (BlockingIOError, ssl.SSLWantReadError):
                return
            if not data:
                raise ProtocolError("the peer closed the connection")
            self.last_heard = time.monotonic()
            self.buffer += data
            if not isinstance(self.socket, ssl.SSLSocket) or not self.socket.pending():
                return

    def tick(self):
        if time.monotonic() >= self.next_beat:
            self.next_beat += 0.5
            self.write("heartbeat", struct.pack("<IIQ", 0, 0, 0))
        if time.monotonic() - self.last_heard > 1.4:
            raise ProtocolError("nothing came from the peer for too long")


class Client:
    """A session. A lost link is taken up again: kept messages of both sides arrive once and in order."""

    def __init__(self, address, role="observer", want_video=False, token=None, tls_file=None, want_debug=False):
        self.address, self.role, self.want_video, self.want_debug = address, role, want_video, want_debug
        self.token, self.tls_file = token, tls_file
        self.session, self.seq, self.waiting = 0, 0, []  # waiting: kept messages that are not acknowledged
        self.received = {"main": 0, "video": 0}
        self.main = self.video = None
        self._connect()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def _hello(self, lane):
        return {"version_min": 1, "version_max": 1, "role": self.role, "software": "counterpart_client.py",
                "resume_session": self.session, "last_seq": self.received[lane], "video": lane == "video",
                "want_video": self.want_video, "want_debug": self.want_debug, "lockstep": False}

    def _connect(self):
        self.main = Lane(self.address, self._hello("main"), self.token, self.tls_file)
        if self.main.welcome.get("resumed"):
            self._acknowledged(self.main.welcome["last_seq"])
            for seq, name, body in self.waiting:
                self.main.write(name, body, seq)
        else:
            self.session, self.seq, self.waiting = self.main.session, 0, []
            self.received = {"main": 0, "video": 0}
            self.main.received = 0
        if self.want_video:
            self.video = Lane(self.address, self._hello("video"), self.token, self.tls_file)

    def _reconnect(self):
        wait = 0.05
        while True:
            for lane in (self.main, self.video):
                if lane is not None:
                    lane.socket.close()
            time.sleep(wait)
            try:
                return self._connect()
            except (OSError, ProtocolError):
                wait = min(0.5, wait * 1.6)

    def _acknowledged(self, seq):
        self.waiting = [entry for entry in self.waiting if entry[0] > seq]

    def send(self, name, body):
        """A kept message (a command, a control, feedback ...)."""
        if name not in KEPT:
            raise ValueError(f"{name} is not a message that a client sends")
        self.seq += 1
        self.waiting.append((self.seq, name, body))
        try:
            self.main.write(name, body, self.seq)
        except OSError:
            self._reconnect()

    def messages(self, seconds=None):
        """Yields (name, body) of everything about the game, until the time is over."""
        end = None if seconds is None else time.monotonic() + seconds
        while end is None or time.monotonic() < end:
            lanes = {"main": self.main, **({"video": self.video} if self.video else {})}
            with selectors.DefaultSelector() as selector:
                for key, lane in lanes.items():
                    selector.register(lane.socket, selectors.EVENT_READ, key)
                ready = [key.data for key, _ in selector.select(0.05)]
            try:
                for key, lane in lanes.items():
                    if key in ready:
                        lane.read()
                    yield from self._take_all(key, lane)
                    lane.tick()
            except (OSError, ProtocolError) as trouble:
                print(f"link lost: {trouble}", file=sys.stderr)
                self._reconnect()

    def _take_all(self, key, lane):
        acknowledge = False
        while message := lane.take():
            name, body, seq = message
            if seq:
                acknowledge = True
                if seq <= self.received[key]:
                    continue
                self.received[key] = seq
            if name is None:
                continue  # of a later version
            body = unpack_body(name, body)
            if name == "clock_request":
                now = time.monotonic_ns()
                lane.write("clock_response", struct.pack("<qqq", body["sent_ns"], now, now))
            elif name == "acknowledge" and key == "main":
                self._acknowledged(body["seq"])
            elif name in ("error", "bye"):
                raise ProtocolError(body.get("message") or body.get("reason") or name)
            elif name not in ("heartbeat", "clock_response", "acknowledge"):
                yield name, body
        if acknowledge:
            lane.write("acknowledge", struct.pack("<Q", self.received[key]))

    def close(self):
        for lane in (self.main, self.video):
            if lane is None:
                continue
            try:
                lane.write("bye", {"reason": "done"})
            except OSError:
                pass
            lane.socket.close()


def main():
    parser = argparse.ArgumentParser(description="Prints what a tracker or renderer says, one JSON object a line.")
    parser.add_argument("address", help="HOST:PORT")
    parser.add_argument("--seconds", type=float, default=None, help="stop after so long")
    parser.add_argument("--send", metavar="JSON", help="a command; its final feedback ends the program")
    parser.add_argument("--video", action="store_true", help="pictures, too (sizes only)")
    parser.add_argument("--token-file")
    parser.add_argument("--tls-file")
    arguments = parser.parse_args()
    token = open(arguments.token_file, "rb").readline().strip() if arguments.token_file else None
    role = "director" if arguments.send else "observer"
    try:
        with Client(arguments.address, role, arguments.video, token, arguments.tls_file) as client:
            command = json.loads(arguments.send) if arguments.send else None
            if command:
                client.send("command", command)
            for name, body in client.messages(arguments.seconds):
                body.pop("data", None)
                print(json.dumps({"type": name, **body}), flush=True)
                if command and name == "feedback" and body["command_id"] == command["id"]:
                    if body["state"] in ("finished", "failed", "cancelled"):
                        return 0 if body["state"] == "finished" else 1
    except (OSError, ProtocolError, ValueError) as trouble:
        print(f"counterpart_client: {trouble}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        pass
    return 1 if arguments.send else 0


if __name__ == "__main__":
    sys.exit(main())
