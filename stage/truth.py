"""What every comparison with the stage's truth needs: poses, the camera, quantiles. Standard library only."""

import csv
import json
import math
import os
import statistics


def read_truth(path):
    """The lines of a truth.jsonl."""
    with open(path) as lines:
        return [json.loads(line) for line in lines]


def read_rows(path):
    """The lines of a tracker's poses.csv."""
    with open(path) as lines:
        return list(csv.DictReader(lines))


def link_pictures(sequence, folder, files):
    """The pictures of a sequence into a folder, and so many of its other files: what is not there cannot be looked at."""
    for name in sorted(os.listdir(sequence)):
        if name.startswith("frame_") or name in files:
            os.symlink(os.path.join(os.path.abspath(sequence), name), os.path.join(folder, name))


def vertices(model):
    """Of a Wavefront OBJ."""
    with open(model) as lines:
        return [[float(word) for word in line.split()[1:4]] for line in lines if line.startswith("v ")]


def median(values):
    return statistics.median(values) if values else math.nan


def rotate(q, v):
    w, x, y, z = q
    t = (2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0]))
    return (v[0] + w * t[0] + y * t[2] - z * t[1],
            v[1] + w * t[1] + z * t[0] - x * t[2],
            v[2] + w * t[2] + x * t[1] - y * t[0])


def project(camera, X_CB, p_B):
    """Where a point of the board's frame is seen, pixels; distortion as OpenCV has it."""
    r = rotate(X_CB["q"], p_B)
    X, Y, Z = (r[i] + X_CB["p"][i] for i in range(3))
    if Z <= 1e-6:
        return (math.inf, math.inf)
    x, y = X / Z, Y / Z
    k1, k2, p1, p2, k3 = camera["dist"]
    r2 = x * x + y * y
    radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
    u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
    v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
    return (camera["fx"] * u + camera["cx"], camera["fy"] * v + camera["cy"])


def corners(camera, X_CB, board):
    """The four corners of the playing surface, pixels, going round it."""
    half = board["squares"] * board["square_size_m"] / 2
    return [project(camera, X_CB, (x, y, 0.0)) for x, y in ((-half, half), (half, half), (half, -half), (-half, -half))]


def rms_px(told, true):
    return math.sqrt(sum((a - c) ** 2 + (b - d) ** 2 for (a, b), (c, d) in zip(told, true)) / len(true))


def degrees_between(a, b):
    dot = min(1.0, abs(sum(x * y for x, y in zip(a, b))))
    return math.degrees(2 * math.acos(dot))


def pose_in(row):
    """X_CB of a line of poses.csv."""
    return {"p": [float(row[k]) for k in ("tx", "ty", "tz")], "q": [float(row[k]) for k in ("qw", "qx", "qy", "qz")]}


def quantile(values, share):
    ordered = sorted(values)
    return ordered[int(share * (len(ordered) - 1))]
