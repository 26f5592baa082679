#!/usr/bin/env python3
"""Starts the stage (or takes a camera), the tracker and the renderer as processes that share nothing but TCP, waits for them,
and writes the report. ./demo builds everything and then runs this; tests run it too. Standard library only."""

import argparse
import json
import math
import os
import re
import signal
import socket
import subprocess
import sys
import time

from truth import corners, degrees_between, median, pose_in, quantile, read_rows, read_truth, rms_px


def say(text):
    print(f"demo: {text}", file=sys.stderr, flush=True)


def fail(text):
    say(text)
    sys.exit(1)


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def is_film(uri):
    """A film ends and answers no moves; a device, a stream or a camera host does."""
    return "://" not in uri and not uri.startswith("/dev/")


class Cast:
    """The processes of one performance."""

    def __init__(self, programs, out):
        self.programs, self.out, self.members = programs, out, []

    def start(self, name, *arguments):
        path = os.path.join(self.programs, name)
        if not os.access(path, os.X_OK):
            fail(f"{path} is not there; build first (./demo does)")
        log = open(os.path.join(self.out, f"{name}.log"), "w")
        process = subprocess.Popen([path, *map(str, arguments)], stdout=log, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
        self.members.append((name, process))
        return process

    def stop(self):
        for _, process in self.members:
            if process.poll() is None:
                process.send_signal(signal.SIGTERM)
        for name, process in self.members:
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                say(f"{name} does not end; killing it")
                process.kill()
                process.wait()

    def failed(self):
        return [(name, p.returncode) for name, p in self.members if p.poll() not in (None, 0)]

    def last_words(self, name):
        with open(os.path.join(self.out, f"{name}.log"), errors="replace") as log:
            lines = [line.rstrip() for line in log if line.strip()]
        return lines[-1] if lines else "(it said nothing)"


def last_frame(poses_file):
    """The number of the newest frame the tracker has logged, from the end of its CSV."""
    try:
        with open(poses_file, "rb") as f:
            f.seek(max(0, os.path.getsize(poses_file) - 600))
            line = f.read().decode(errors="replace").rstrip("\n").rsplit("\n", 1)[-1]
        return int(line.split(",")[0]) + 1
    except (OSError, ValueError):
        return 0


def recorded_moves(pdn_file):
    """How many moves of both players the record holds."""
    try:
        with open(pdn_file) as f:
            return len(re.findall(r"\b\d+[-x]\d+", re.sub(r"\[.*?\]|\{.*?\}", "", f.read(), flags=re.S)))
    except OSError:
        return 0


def watch(cast, tracker, out, options):
    """Waits for the tracker to end, or for the moves that are wanted, with a line of progress every few seconds."""
    shown = 0.0
    frames = options.frames
    started = time.monotonic()
    while tracker.poll() is None:
        time.sleep(0.2)
        for name, code in cast.failed():
            if name != "tracker_server":
                cast.stop()
                fail(f"{name} failed (exit {code}): {cast.last_words(name)}")
        now = time.monotonic()
        if now - shown > 5:
            shown = now
            done = last_frame(out("poses.csv"))
            total = f" of {frames}" if frames else ""
            moves = recorded_moves(out("demo.pdn"))
            say(f"frame {done}{total}, {moves} moves, {done / max(now - started, 1e-9):.1f} a second")
            if options.moves and moves >= options.moves:
                tracker.send_signal(signal.SIGTERM)
                tracker.wait(60)


def summary(values):
    if not values:
        return None
    return {"median": median(values), "p95": quantile(values, 0.95), "max": max(values)}


def pose_error(poses_file, truth_file):
    """The tracker's poses against the stage's truth: millimetres, degrees, and pixels at the board's corners."""
    truth = {entry["frame"]: entry for entry in read_truth(truth_file)}
    mm, degrees, pixels, lost, compared = [], [], [], 0, 0
    for row in read_rows(poses_file):
        entry = truth.get(int(row["frame"]))
        if entry is None:
            continue
        compared += 1
        if row["status"] == "lost":
            lost += 1
            continue
        true, told = entry["X_CB"], pose_in(row)
        mm.append(1000 * math.dist(told["p"], true["p"]))
        degrees.append(degrees_between(told["q"], true["q"]))
        camera, board = entry["intrinsics"], entry["board"]
        pixels.append(rms_px(corners(camera, told, board), corners(camera, true, board)))
    return {"frames_compared": compared, "lost": lost, "mm": summary(mm), "deg": summary(degrees), "corner_px_rms": summary(pixels)}


def read_json(path):
    try:
        with open(path) as f:
            return json.load(f)
    except (OSError, ValueError):
        return None


def contact_sheet(film, sheet, frames, wanted=24):
    step = max(1, frames // wanted)
    chain = f"select='not(mod(n\\,{step}))',scale=360:-2,tile=4x{math.ceil(wanted / 4)}:padding=4"
    done = subprocess.run(["ffmpeg", "-v", "error", "-y", "-i", film, "-vf", chain, "-frames:v", "1", "-vsync", "vfr", sheet],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode != 0:
        fail(f"ffmpeg could not make {sheet}: {done.stderr.strip()}")


def parse():
    parser = argparse.ArgumentParser(prog="demo", add_help=False)
    parser.add_argument("--programs", required=True)
    parser.add_argument("--camera", default="")
    parser.add_argument("--squares", type=int, choices=(8, 10), default=10)
    parser.add_argument("--frames", type=int, default=0)
    parser.add_argument("--headless", action="store_true")
    parser.add_argument("--out", default="out")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--scenario", default="", help="of the stage, instead of a plain game")
    parser.add_argument("--moves", type=int, default=0, help="end when so many have been recorded, both players' counted")
    options = parser.parse_args()
    if options.frames < 0:
        parser.error("--frames cannot be negative")
    if not options.camera and not options.frames and not options.moves and options.headless:
        options.frames = 4000
    if options.camera and is_film(options.camera) and not os.path.exists(options.camera):
        fail(f"there is no camera, film or folder '{options.camera}'")
    return options


def perform(options):
    out = lambda name: os.path.join(options.out, name)
    cast = Cast(options.programs, options.out)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    tracker_address = f"127.0.0.1:{free_port() if options.headless else 7401}"
    pace = ["--lockstep"] if options.headless else []
    count = ["--frames", options.frames] if options.frames else []
    try:
        camera = options.camera
        if not camera:
            stage_address = f"127.0.0.1:{free_port() if options.headless else 7403}"
            scenario = options.scenario or os.path.join(os.path.dirname(os.path.abspath(__file__)), "scenarios",
                                    "demo.json" if options.squares == 10 else "demo8.json")
            cast.start("stage", "serve", "--listen", stage_address, "--scenario", scenario, "--seed", options.seed,
                       "--truth", out("truth.jsonl"), *pace)
            camera = f"vhp://{stage_address}"
        show = ["--activity", "show"] if options.camera and is_film(options.camera) else []
        tracker = cast.start("tracker_server", "serve", "--camera", camera, "--squares", options.squares, "--listen",
                             tracker_address, "--pdn", out("demo.pdn"), "--poses", out("poses.csv"), "--report",
                             out("tracker.json"), *show, *pace, *count)
        web = [] if options.headless else ["--web", "127.0.0.1:8080"]
        cast.start("vhd_renderer", "serve", "--tracker", tracker_address, "--output", out("demo.mp4"), "--report",
                   out("renderer.json"), *web, *pace)
        if web:
            say("the mirror is at http://127.0.0.1:8080 (Ctrl-C ends)")
        watch(cast, tracker, out, options)
        for name, process in cast.members:
            if name == "vhd_renderer":
                try:
                    process.wait(30)  # it finishes the film when the tracker says goodbye
                except subprocess.TimeoutExpired:
                    pass
    except KeyboardInterrupt:
        say("stopping")
    finally:
        cast.stop()
    for name, code in cast.failed():
        fail(f"{name} failed (exit {code}): {cast.last_words(name)}")


def report(options):
    out = lambda name: os.path.join(options.out, name)
    tracker, renderer = read_json(out("tracker.json")), read_json(out("renderer.json"))
    if tracker is None or renderer is None:
        fail(f"a daemon left no report in {options.out}; see the logs there")
    result = {"camera": options.camera or "stage", "frames": tracker["frames"], "frames_with_pose": tracker["frames_with_pose"],
              "composited": renderer["frames"], "drops": {"camera": tracker["camera_dropped"], "renderer": renderer["dropped"]},
              "moves": tracker["moves"], "captured": tracker["captured"], "illegal_moves": tracker["illegal_moves"],
              "ms": {"tracker_server": tracker["ms"], "vhd_renderer": renderer["ms"]}}
    if not options.camera:
        result["pose_error"] = pose_error(out("poses.csv"), out("truth.jsonl"))
    with open(out("report.json"), "w") as f:
        json.dump(result, f, indent=2)
        f.write("\n")
    if not os.path.exists(out("demo.pdn")):
        with open(out("demo.pdn"), "w") as f:
            f.write('[Event "Show"]\n[Result "*"]\n\n*\n')
    contact_sheet(out("demo.mp4"), out("contact-sheet.png"), renderer["frames"])
    say(f"{result['frames']} frames, {len(result['moves'])} moves, {result['captured']} pieces captured, "
        f"{len(result['illegal_moves'])} illegal moves noticed; see {options.out}/")


def main():
    options = parse()
    os.makedirs(options.out, exist_ok=True)
    # A report must never be mistaken for an older run's.
    for name in ("demo.mp4", "demo.pdn", "report.json", "contact-sheet.png", "poses.csv", "truth.jsonl", "tracker.json", "renderer.json"):
        if os.path.exists(os.path.join(options.out, name)):
            os.remove(os.path.join(options.out, name))
    perform(options)
    report(options)


if __name__ == "__main__":
    main()
