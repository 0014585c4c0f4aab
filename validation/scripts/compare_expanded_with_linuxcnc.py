#!/usr/bin/env python3
"""Compares programs that kinetostat-program writes flat with LinuxCNC's interpreter: cutter radius compensation.

    validation/scripts/compare_expanded_with_linuxcnc.py [--programs N] [--seed N] [--keep FOLDER] [--lines N] [--expand FILE]

Random contours (in XY and ZX; lines, arcs and circles, corners of all angles, both sides, places and increments, inches and millimetres,
work offsets, G92, moves in depth, rapids, stops) are run by LinuxCNC as they are, and as kinetostat has written them flat.
Both must make the same canonical moves: the same kinds in the same order, places and centres to 1e-9 mm, feeds alike. What
LinuxCNC refuses kinetostat must refuse; what only kinetostat refuses is counted by its reason.

LinuxCNC (Debian: linuxcnc-uspace) runs in a process of its own; without it the script says so and ends with 0. Exit status
1: a difference, or a program that only LinuxCNC refuses.
"""

import argparse
import collections
import json
import math
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

from compare_with_linuxcnc import MM, ROOT, ask_linuxcnc, linuxcnc_python, write_parameters

PLACE_MM = 1e-9


def in_zx(line):
    """A block of the plane XY in the plane ZX."""
    letters = dict(zip("XYZIJ", "ZXYKI"))
    code, comment, rest = line.partition("(")
    if code.startswith("O"):
        return line
    code = re.sub(r"([XYZIJ])(?=[-\d.])", lambda word: letters[word.group(1)], code.replace("G17", "G18"))
    return code + comment + rest


class Contours:
    """Writes a random program with cutter radius compensation."""

    def __init__(self, seed):
        self.r = random.Random(seed)
        self.lines = []
        self.inch = self.r.random() < 0.25
        self.incremental = False
        self.centres = False
        self.at = [0.0, 0.0]
        self.heading = self.r.uniform(-math.pi, math.pi)
        self.scale = 1 / 25.4 if self.inch else 1.0
        self.digits = self.r.choice([3, 4, 6])
        # In the plane ZX, which has no polar words.
        self.lathe = self.r.random() < 0.2
        # Many contours have corners of a few kinds only, so that most of them can be cut.
        self.wild = self.r.random() < 0.35

    def number(self, value):
        text = f"{round(value, self.digits + (2 if self.inch else 0)):.8f}".rstrip("0").rstrip(".")
        return "0" if text in ("-0", "") else text

    def rounded(self, value):
        return float(self.number(value))

    def end_words(self, to):
        words = ""
        for axis in range(2):
            here = self.at[axis]
            if self.incremental:
                way = self.rounded(to[axis] - here)
                if way != 0 or self.r.random() < 0.3:
                    words += f" {'XY'[axis]}{self.number(way)}"
                self.at[axis] = here + way
            else:
                place = self.rounded(to[axis])
                if place != here or self.r.random() < 0.5:
                    words += f" {'XY'[axis]}{self.number(place)}"
                self.at[axis] = place
        return words

    def turn(self):
        r = self.r
        kind = r.random()
        if kind < 0.25:
            return 0.0
        if kind < 0.35:
            return r.choice([1, -1]) * math.pi / 2
        if kind < 0.4:
            return r.choice([1, -1]) * r.uniform(0, 0.12)
        if kind < 0.44 and self.wild:
            return math.pi + r.choice([0, 0, r.uniform(-0.1, 0.1)])
        return r.uniform(-math.pi, math.pi) if self.wild else r.uniform(-2.2, 2.2)

    def tail(self):
        r = self.r
        words = ""
        if r.random() < 0.15:
            words += f" Z{self.number(r.uniform(-5, 5) * self.scale)}"
        if r.random() < 0.15:
            words += f" F{r.randrange(50, 900)}"
        if r.random() < 0.08:
            words += " (comment)"
        return words

    def straight(self, code=None, length=None):
        code = code or ("G0" if self.r.random() < 0.08 else "G1")
        length = (length or self.r.choice([self.r.uniform(4, 60), self.r.uniform(4, 60), self.r.uniform(0.5, 6)])) * self.scale
        to = [self.at[0] + length * math.cos(self.heading), self.at[1] + length * math.sin(self.heading)]
        before = list(self.at)
        self.lines.append(code + self.end_words(to) + self.tail())
        if before != self.at:
            self.heading = math.atan2(self.at[1] - before[1], self.at[0] - before[0])

    def polar(self):
        """A straight move by radius and angle about the origin."""
        r = self.r
        radius, angle = math.hypot(*self.at), math.degrees(math.atan2(self.at[1], self.at[0]))
        if radius < 3 * self.scale or self.lathe:
            return self.straight()
        words = "G1"
        if r.random() < 0.7:
            more = self.rounded(r.uniform(-10, 30) * self.scale)
            words += f" @{self.number(more if self.incremental else self.rounded(radius + more))}"
            radius = radius + more if self.incremental else self.rounded(radius + more)
        if words == "G1" or r.random() < 0.5:
            more = round(r.uniform(-60, 60), 3)
            words += f" ^{more if self.incremental else round(angle + more, 3):.3f}"
            angle = angle + more if self.incremental else round(angle + more, 3)
        if radius <= 0:
            return self.straight()
        before = list(self.at)
        self.at = [radius * math.cos(math.radians(angle)), radius * math.sin(math.radians(angle))]
        self.lines.append(words + self.tail())
        self.heading = math.atan2(self.at[1] - before[1], self.at[0] - before[0])

    def loop(self):
        """A row of equal steps in a loop, by increments."""
        r = self.r
        if self.incremental:
            return self.straight()
        way = [self.rounded(r.uniform(2, 12) * self.scale * c) for c in (math.cos(self.heading), math.sin(self.heading))]
        other = [self.rounded(r.uniform(2, 12) * self.scale * c) for c in (math.cos(self.heading - 1), math.sin(self.heading + 1))]
        times = r.randrange(1, 4)
        number = len(self.lines) + 100
        self.lines += ["G91", f"O{number} repeat [{times}]"]
        self.lines += [f"G1 X{self.number(step[0])} Y{self.number(step[1])}" for step in (way, other)]
        self.lines += [f"O{number} endrepeat", "G90"]
        self.at = [self.at[axis] + times * (way[axis] + other[axis]) for axis in range(2)]
        # The place is known but for its last digits; it is stated anew.
        self.straight("G1")

    def arc(self):
        r = self.r
        sense = r.choice([1, -1])
        radius = r.choice([r.uniform(4, 40), r.uniform(1, 6)]) * self.scale
        sweep = r.choice([math.pi / 2, r.uniform(0.2, 3), r.uniform(0.3, 6.1)])
        start = list(self.at)
        way = [-sense * math.sin(self.heading) * radius, sense * math.cos(self.heading) * radius]
        way = [float(f"{value:.7f}") for value in way]
        if way == [0.0, 0.0]:
            return
        centre = [start[0] + way[0], start[1] + way[1]]
        if r.random() < 0.07:
            sweep, to = 2 * math.pi, start
        else:
            angle = math.atan2(-way[1], -way[0]) + sense * sweep
            distance = math.hypot(*way)
            to = [centre[0] + distance * math.cos(angle), centre[1] + distance * math.sin(angle)]
        digits, self.digits = self.digits, 6
        words = ("G3" if sense > 0 else "G2") + self.end_words(to)
        if sweep < 5.5 and abs(sweep - math.pi) > 0.1 and r.random() < 0.3:
            # Where the centre is by the radius decides the next heading only a little.
            words += f" R{math.hypot(*way) * (1 if sweep < math.pi else -1):.7f}"
        elif self.centres:
            words += f" I{centre[0]:.7f} J{centre[1]:.7f}"
        else:
            words += f" I{way[0]:.7f} J{way[1]:.7f}"
        self.digits = digits
        self.lines.append(words + self.tail())
        self.heading = math.atan2(self.at[1] - centre[1], self.at[0] - centre[0]) + sense * math.pi / 2

    def between(self):
        """A block that is no motion along the contour."""
        r = self.r
        choices = ["M3 S1000", "M8", "M9", "F300", "(words)", "G4 P0.1", "depth", "depth", "mode", "centres", "N7 F120"]
        if self.wild:
            choices += ["M1", "M0", "units", "G1", "G80"]
        choice = r.choice(choices)
        if choice == "depth":
            z = r.uniform(-5, 5) * self.scale
            choice = f"{r.choice(['G0', 'G1'])} Z{self.number(z)}"
        elif choice == "mode":
            self.incremental = not self.incremental
            choice = "G91" if self.incremental else "G90"
        elif choice == "centres":
            self.centres = not self.centres
            choice = "G90.1" if self.centres else "G91.1"
        elif choice == "units":
            self.inch = not self.inch
            factor = 1 / 25.4 if self.inch else 25.4
            self.scale = 1 / 25.4 if self.inch else 1.0
            # Only from here on the coordinates are only nearly known: they are stated anew.
            self.at = [value * factor for value in self.at]
            self.lines += ["G20", "F20"] if self.inch else ["G21", "F400"]
            if self.incremental:
                return
            self.straight("G1")
            return
        elif choice == "G80":
            self.lines.append("G80")
            choice = "G1"
        self.lines.append(choice)

    def contour(self):
        r = self.r
        diameter = r.choice([0.5, 1, 2, 3, 6.35, 12, r.uniform(0.2, 14)]) * self.scale
        if r.random() < 0.08:
            diameter = -diameter
        switch = f"{r.choice(['G41.1', 'G42.1'])} D{diameter:.5f}"
        if r.random() < 0.15:
            switch += " (on)"
        if r.random() < 0.3:
            self.lines.append(switch + " ")
            switch = ""
        else:
            self.lines.append(switch)
        if r.random() < 0.75:
            self.straight(r.choice(["G1", "G1", "G0"]), r.uniform(6, 40))
        else:
            self.arc()
        for _ in range(r.randrange(1, 9)):
            if r.random() < 0.2:
                self.between()
            self.heading += self.turn()
            kind = r.random()
            if kind < 0.55:
                self.straight()
            elif kind < 0.94:
                self.arc()
            else:
                (self.polar if kind < 0.97 else self.loop)()
        if r.random() < 0.95:
            if r.random() < 0.5:
                self.lines.append("G40")
                if r.random() < 0.3:
                    self.lines.append(r.choice(["M9", "F250", "G0 Z5", "G91 G1 Z1", "G90"]))
                    self.incremental = {"G91 G1 Z1": True, "G90": False}.get(self.lines[-1], self.incremental)
            else:
                self.heading += self.turn()
                self.straight("G40 " + r.choice(["G0", "G1"]))
            if r.random() < 0.93:
                self.straight(r.choice(["G0", "G1"]))
            return True
        return False

    def program(self, offsets):
        r = self.r
        self.lines = ["G20" if self.inch else "G21", "G90 G17 G91.1 G94"]
        if offsets:
            self.lines.append(r.choice(["G54", "G55", "G57", "G59.2"]))
        self.lines.append(f"F{r.randrange(100, 900)}")
        place = [self.rounded(r.uniform(-80, 80) * self.scale) for _ in range(2)]
        self.lines.append(f"G0 X{self.number(place[0])} Y{self.number(place[1])} Z{self.number(5 * self.scale)}")
        self.at = place
        if offsets and r.random() < 0.3:
            self.at = [self.rounded(r.uniform(-20, 20) * self.scale) for _ in range(2)]
            self.lines.append(f"G92 X{self.number(self.at[0])} Y{self.number(self.at[1])}")
        for _ in range(r.choice([1, 1, 2])):
            if not self.contour():
                break
        self.lines.append("M2")
        if self.lathe:
            self.lines = [in_zx(line) for line in self.lines]
        return "\n".join(self.lines) + "\n"


def build_expand():
    command = ["cargo", "build", "-q", "-j2", "-p", "kinetostat-program", "--example", "expand", "--message-format=json"]
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    for line in done.stdout.splitlines():
        item = json.loads(line)
        if item.get("executable") and item["target"]["name"] == "expand":
            return item["executable"]
    raise SystemExit("cargo built no example `expand`")


def ask_expand(expand, names, into):
    """The reason of a refusal by name; None where the program was written."""
    answers = {}
    for first in range(0, len(names), 500):
        done = subprocess.run([expand, "--into", str(into), *names[first : first + 500]], capture_output=True, text=True, check=True)
        for line in done.stdout.splitlines():
            name, _, reason = line.partition("\t")
            answers[name] = reason or None
    return answers


def moves(events):
    """Moves with a length: kind, end, feed, arc."""
    made, last = [], None
    for _line, kind, end, feed, arc in events:
        if arc is None and last is not None and max(abs(a - b) for a, b in zip(end, last)) < PLACE_MM:
            continue
        made.append((kind, end, feed, arc))
        last = end
    return made


def difference(one, other):
    """What is different between two rows of moves, or None, and the largest distance."""
    worst = 0.0
    if len(one) != len(other):
        return f"{len(one)} moves, {len(other)} flat ones", worst
    for index, ((kind, end, feed, arc), (flat_kind, flat_end, flat_feed, flat_arc)) in enumerate(zip(one, other)):
        if kind != flat_kind or (arc is None) != (flat_arc is None):
            return f"move {index} is {kind} {arc}, flat {flat_kind} {flat_arc}", worst
        apart = max(abs(a - b) for a, b in zip(end, flat_end))
        if arc is not None:
            if arc[0] != flat_arc[0] or arc[2] != flat_arc[2]:
                return f"move {index} turns {arc}, flat {flat_arc}", worst
            axes = arc[0][:2]
            apart = max(apart, max(abs(arc[1][axis] - flat_arc[1][axis]) for axis in axes))
        worst = max(worst, apart)
        if not apart <= PLACE_MM:
            return f"move {index} is {apart:.3e} mm away: {end} {arc}, flat {flat_end} {flat_arc}", worst
        if abs(feed - flat_feed) > 1e-9 * max(feed, 1.0):
            return f"move {index} has the feed {feed}, flat {flat_feed}", worst
    return None, worst


def compare(python, expand, folder, count, seed, offsets, lines):
    parameters = folder / "parameters.var"
    write_parameters(parameters, offsets)
    flat = folder / f"flat-{seed}-{int(offsets)}"
    flat.mkdir(exist_ok=True)
    names = []
    for index in range(count):
        name = folder / f"c{seed}-{int(offsets)}-{index}.ngc"
        name.write_text(Contours(seed * 1_000_003 + index).program(offsets))
        names.append(str(name))
    mine = ask_expand(expand, names, flat)
    theirs = ask_linuxcnc(python, names, parameters)
    written = [name for name in names if mine[name] is None]
    flat_of = {name: str(flat / pathlib.Path(name).name) for name in written}
    theirs_flat = ask_linuxcnc(python, list(flat_of.values()), parameters)
    counts = collections.Counter()
    classes = collections.defaultdict(list)
    wrong, worst, where = False, 0.0, None
    for name in names:
        error = theirs[name]["error"]
        if error is not None and mine[name] is not None:
            counts["refused by both"] += 1
            # A line of LinuxCNC's is that of its reading, or the one before.
            line = int(re.match(r"line (\d+)", mine[name]).group(1))
            near = theirs[name]["line"] - line in (0, 1)
            counts["refused by both at the same line"] += near
            if line < theirs[name]["line"] - 1:
                classes["kinetostat refuses earlier: " + mine[name].split("`: ", 1)[-1][:90]].append(f"{name}: {mine[name]} | {theirs[name]['line']} {theirs[name]['error']}")
        elif error is not None:
            classes["ONLY LINUXCNC REFUSES: " + error.split(":")[0]].append(f"{name}:{theirs[name]['line']}")
            wrong = True
        elif mine[name] is not None:
            reason = re.sub(r"-?\d+(\.\d+)?(e-?\d+)?", "#", mine[name].split("`: ", 1)[-1].split(";")[0])
            counts["refused by kinetostat only"] += 1
            classes["only kinetostat refuses: " + reason[:110]].append(f"{name}: {mine[name]}")
        elif theirs_flat[flat_of[name]]["error"] is not None:
            classes["LINUXCNC REFUSES THE FLAT PROGRAM: " + theirs_flat[flat_of[name]]["error"]].append(name)
            wrong = True
        else:
            one = moves(theirs[name]["events"])
            what, apart = difference(one, moves(theirs_flat[flat_of[name]]["events"]))
            if apart > worst:
                worst, where = apart, name
            counts["accepted by both"] += 1
            counts["moves compared"] += len(one)
            if what is not None:
                classes["DIFFERENT: " + re.sub(r"[-\d.e\[\], ]+", " ", what)[:60]].append(f"{name}: {what}")
                wrong = True
    print(f"{count} random contours" + (", work offsets" if offsets else "") + f" (seed {seed})")
    for what, number in sorted(counts.items()):
        print(f"  {what}: {number}")
    print(f"  largest difference: {worst:.2e} mm" + (f" ({where})" if where else ""))
    for kind, examples in sorted(classes.items(), key=lambda item: -len(item[1])):
        print(f"  {len(examples):5} {kind}")
        for example in examples[:lines]:
            print(f"          {example}")
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=int, default=2000, help="random contours (half as many again with work offsets)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the programs; otherwise they are removed")
    parser.add_argument("--lines", type=int, default=1, help="examples shown of each kind")
    parser.add_argument("--expand", type=pathlib.Path, help="the example `expand`, if it is built already")
    options = parser.parse_args()
    python = linuxcnc_python()
    if python is None:
        print("SKIPPED: LinuxCNC's Python module `gcode` is not installed (Debian: linuxcnc-uspace); nothing was compared")
        return 0
    expand = str(options.expand or build_expand())
    folder = options.keep or pathlib.Path(tempfile.mkdtemp())
    folder.mkdir(parents=True, exist_ok=True)
    try:
        wrong = compare(python, expand, folder, options.programs, options.seed, False, options.lines)
        wrong |= compare(python, expand, folder, options.programs // 2, options.seed, True, options.lines)
    finally:
        if options.keep is None:
            shutil.rmtree(folder)
    return int(wrong)


if __name__ == "__main__":
    sys.exit(main())
