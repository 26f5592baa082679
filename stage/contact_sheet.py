#!/usr/bin/env python3
"""Draws one frame of every scenario in a folder and lays them out as one picture, for looking at.
  stage/contact_sheet.py [--scenarios FOLDER] [--out docs/pictures/scenarios.jpg]
Needs ffmpeg. Standard library only."""

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))


def telling_frame(scenario):
    """The middle of the first event, or a moment at which the player is at work."""
    frames = scenario.get("frames", 250)
    fps = scenario.get("camera", {}).get("fps", 25)
    for event in scenario.get("events", []):
        if event.get("at_s", 0) < 20:
            middle = event.get("at_s", 0) + min(event.get("for_s", 1) / 2, 2)
            settled = event.get("for_s", 1) if event["kind"] in ("nudge_board", "bump_camera") else 0
            return min(frames - 1, int(fps * (middle + settled)))
    return min(frames - 1, 44)


def ffmpeg(source, filters, target):
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-i", source, "-vf", filters, "-frames:v", "1", "-q:v", "4", target],
                   check=True, stdin=subprocess.DEVNULL)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenarios", default=os.path.join(HERE, "scenarios"))
    parser.add_argument("--out", default=os.path.join(HERE, "..", "docs", "pictures", "scenarios.jpg"))
    parser.add_argument("--programs", default=os.path.join(HERE, "..", "build", "dev", "bin"))
    parser.add_argument("--columns", type=int, default=6)
    options = parser.parse_args()
    names = sorted(f[:-5] for f in os.listdir(options.scenarios) if f.endswith(".json"))
    os.makedirs(os.path.dirname(os.path.abspath(options.out)), exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        for i, name in enumerate(names):
            path = os.path.join(options.scenarios, name + ".json")
            with open(path) as f:
                frame = telling_frame(json.load(f))
            film = os.path.join(folder, name)
            done = subprocess.run([os.path.join(options.programs, "stage"), "render", path, "--out", film, "--from", str(frame),
                                   "--frames", "1"], stderr=subprocess.PIPE, text=True)
            if done.returncode != 0:
                sys.exit(f"contact_sheet: {name}: {done.stderr}")
            os.rename(os.path.join(film, f"frame_{frame:05d}.png"), os.path.join(folder, f"{i:03d}.png"))
            print(f"{i // options.columns + 1}.{i % options.columns + 1} {name}, frame {frame}", flush=True)
        rows = math.ceil(len(names) / options.columns)
        # Pictures of several sizes make ffmpeg start anew, so each is brought to one size first.
        for i in range(len(names)):
            ffmpeg(os.path.join(folder, f"{i:03d}.png"), "scale=360:288:force_original_aspect_ratio=increase,crop=360:288",
                   os.path.join(folder, f"small_{i:03d}.png"))
        ffmpeg(os.path.join(folder, "small_%03d.png"), f"tile={options.columns}x{rows}:padding=4", options.out)


if __name__ == "__main__":
    main()
