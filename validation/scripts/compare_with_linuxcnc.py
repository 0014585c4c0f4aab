#!/usr/bin/env python3
"""Compares kinetostat-program with LinuxCNC's interpreter, an independent reader of G-code.

    validation/scripts/compare_with_linuxcnc.py [--programs N] [--mutants N] [--corrected N] [--seed N]
                                     [--keep FOLDER] [--lines N] [--moves FILE] [PROGRAM ...]

Four comparisons over random programs (the same for the same seed):

1. where each move ends, the centre, sense and sweep of each arc, each feed;
2. what the two accept and refuse, over programs with one word changed;
3. programs written by kinetostat with made-up corrections: LinuxCNC must accept them and go where
   kinetostat says it commanded, as fast as programmed;
4. the same for the programs named on the command line.

LinuxCNC (Debian: linuxcnc-uspace) runs in a process of its own; without it the script says so and
ends with 0. Exit status 1: a difference that this script does not know.
"""

import argparse
import collections
import json
import math
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

from linuxcnc_tools import environment_with_tools, load_tools

ROOT = pathlib.Path(__file__).resolve().parents[2]
MM = 25.4
PLACE_MM = 1e-6
# Of G28 and G30, as `moves --machine` has them.
REFERENCES_MM = [(-12.5, 60.25, 110.0), (33.0, -8.75, 95.5)]


# --- the side of LinuxCNC: a process of its own ---------------------------------------------------


class Canon:
    """Takes the calls of LinuxCNC's interpreter down, in inches; calls that do not matter are ignored."""

    def __init__(self, parameter_file):
        self.parameter_file = parameter_file
        self.g5x = self.g92 = (0.0,) * 3
        self.plane = 1
        self.feed = 0.0
        self.line = 0
        self.events = []

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return lambda *arguments: None

    def next_line(self, state):
        self.line = state.sequence_number

    def set_g5x_offset(self, _index, x, y, z, *_rest):
        self.g5x = (x, y, z)

    def set_g92_offset(self, x, y, z, *_rest):
        self.g92 = (x, y, z)

    def set_plane(self, plane):
        self.plane = plane

    def set_feed_rate(self, feed):
        self.feed = feed

    def place(self, xyz):
        return [(xyz[axis] + self.g92[axis] + self.g5x[axis]) * MM for axis in range(3)]

    def straight_traverse(self, x, y, z, *_rest):
        self.events.append([self.line, "rapid", self.place((x, y, z)), 0.0, None])

    def straight_feed(self, x, y, z, *_rest):
        self.events.append([self.line, "feed", self.place((x, y, z)), self.feed * MM, None])

    def arc_feed(self, first, second, centre_first, centre_second, turns, end, *_rest):
        axes = {1: (0, 1, 2), 2: (1, 2, 0), 3: (2, 0, 1)}[self.plane]
        to, centre = [0.0] * 3, [0.0] * 3
        for axis, at, about in zip(axes, (first, second, end), (centre_first, centre_second, end)):
            to[axis], centre[axis] = at, about
        arc = [axes, self.place(centre), turns]
        self.events.append([self.line, "feed", self.place(to), self.feed * MM, arc])

    def get_tool(self, _index):
        return (-1,) + (0.0,) * 12 + (0,)

    def get_external_angular_units(self):
        return 1.0

    def get_external_length_units(self):
        return 1.0

    def get_axis_mask(self):
        return 0o777

    def get_block_delete(self):
        return 0


def worker(parameter_file):
    """Reads names of programs from the standard input, writes one line of JSON for each."""
    load_tools()
    import gcode  # LinuxCNC's; only ever loaded in this process

    for name in sys.stdin.read().splitlines():
        shutil.copyfile(parameter_file, parameter_file + ".run")
        canon = Canon(parameter_file + ".run")
        try:
            # The length of the tool would go on from the program before.
            result, line = gcode.parse(name, canon, "G21", "G49")
            error = gcode.strerror(result) if result > gcode.MIN_ERROR else None
        except Exception as problem:  # the interpreter raises all kinds
            error, line = str(problem), canon.line
        answer = {"file": name, "error": error, "line": line, "events": canon.events}
        print(json.dumps(answer), flush=True)


def write_parameters(path, offsets):
    """A complete parameter file; the origins are those of `moves --offsets`."""
    values = {number: 0.0 for number in [*range(5161, 5170), *range(5181, 5190), *range(5210, 5220)]}
    values[5220] = 1.0
    for first, point in zip((5161, 5181), REFERENCES_MM):
        values.update({first + axis: point[axis] for axis in range(3)})
    for system in range(9):
        origin = (12.7 * system, -2.54 * (system + 1), 0.254 * system * system) if offsets else (0.0,) * 3
        for index in range(10):
            values[5221 + 20 * system + index] = origin[index] if index < 3 else 0.0
    path.write_text("".join(f"{number}\t{value:.15f}\n" for number, value in sorted(values.items())))


def linuxcnc_python():
    """A Python that knows LinuxCNC's module."""
    for folder in os.environ.get("PATH", "").split(os.pathsep):
        python = shutil.which("python3", path=folder)
        if python and subprocess.run([python, "-c", "import gcode; gcode.parse"], capture_output=True).returncode == 0:
            return python
    return None


def ask_linuxcnc(python, names, parameters):
    answers = {}
    left = list(names)
    environment = environment_with_tools(parameters.resolve().parent, dict.fromkeys(range(1, 100), 0.0))
    while left:
        done = subprocess.run(
            [python, __file__, "--worker", str(parameters)], input="\n".join(left), capture_output=True, text=True, env=environment
        )
        lines = [json.loads(line) for line in done.stdout.splitlines() if line.startswith('{"file"')]
        for answer in lines:
            answers[answer["file"]] = answer
        left = left[len(lines) :]
        if left:
            answers[left[0]] = {"file": left[0], "error": "LinuxCNC ended: " + done.stderr[-200:], "line": 0, "events": []}
            left = left[1:]
    return answers


def ask_kinetostat(moves, names, *options):
    done = subprocess.run([moves, "--machine", *options, "-"], input="\n".join(names), capture_output=True, text=True, check=True)
    answers, current = {}, None
    for line in done.stdout.splitlines():
        if not line:
            continue
        item = json.loads(line)
        if "file" in item:
            current = answers[item["file"]] = {**item, "moves": []}
        else:
            current["moves"].append(item)
    return answers


def build_moves():
    command = ["cargo", "build", "--release", "-j1", "-q", "-p", "kinetostat-program", "--example", "moves", "--message-format=json"]
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    for line in done.stdout.splitlines():
        item = json.loads(line)
        if item.get("executable") and item["target"]["name"] == "moves":
            return item["executable"]
    raise SystemExit("cargo built no example `moves`")


# --- random programs ------------------------------------------------------------------------------


class Writer:
    """Writes a random program that both interpreters are to accept."""

    def __init__(self, seed):
        self.r = random.Random(seed)
        self.lines = []
        self.style = self.r.choice(["spaced", "spaced", "dense", "mixed"])
        self.numbered = self.r.random() < 0.3
        self.lower = self.r.random() < 0.2
        self.repeat = self.r.random() < 0.3
        self.inch = False
        self.incremental = False
        self.absolute_centre = False
        self.plane = 17
        self.feed_mode = 94
        self.system = 0
        self.offset = [0.0] * 3
        self.saved = None  # G92.3 brings back nothing known before the first G92 or G92.1
        self.at = [0.0] * 3
        self.motion = None
        self.has_feed = False
        self.origins = [(0.0,) * 3] * 9
        self.length = 0.0
        self.in_force = False
        self.height_unknown = False  # to a reader that does not know the tool's length

    def number(self, value, decimals=None):
        """A number and the value it has."""
        r = self.r
        decimals = r.choice([0, 1, 2, 3, 3, 4, 4, 5, 6]) if decimals is None else decimals
        text = f"{value:.{decimals}f}"
        value = float(text)
        sign, digits = ("-", text[1:]) if text[0] == "-" else ("", text)
        if "." in digits and r.random() < 0.3:
            digits = digits.rstrip("0")
        if digits.startswith("0.") and len(digits) > 2 and r.random() < 0.3:
            digits = digits[1:]
        elif r.random() < 0.05:
            digits = "0" + digits
        if "." not in digits and r.random() < 0.2:
            digits += "."
        if not sign and r.random() < 0.03:
            sign = "+"
        return sign + digits, value

    def block(self, words, comment=True):
        r = self.r
        words = list(words)
        if r.random() < 0.3:
            r.shuffle(words)
        numbered = self.numbered or r.random() < 0.03
        if numbered:
            words.insert(0, f"N{len(self.lines) * 10 % 99990}")
        if self.lower:
            words = [word.lower() if r.random() < 0.9 else word for word in words]
        if comment and r.random() < 0.08:
            words.insert(r.randrange(int(numbered), len(words) + 1), r.choice(["(cut)", "(X9 Y9)", "( G0 )", "(a; b)", "()"]))
        gap = {"spaced": lambda: " ", "dense": lambda: "", "mixed": lambda: r.choice(["", " ", "  ", "\t"])}[self.style]
        line = "".join((gap() if index else "") + word for index, word in enumerate(words))
        if comment and r.random() < 0.05:
            line += r.choice([" ; X5 Y5", ";done", " (end)"])
        self.lines.append(line)

    def code(self, number, letter="G"):
        whole = f"{number}"
        return letter + ("0" + whole if number in (0, 1, 2, 3) and self.r.random() < 0.4 else whole)

    def origin(self, axis):
        return self.origins[self.system][axis] + self.offset[axis]

    def unit(self):
        return MM if self.inch else 1.0

    def coordinate(self, axis, place, decimals=None):
        """The word for a place in mm; returns the word and the place really reached."""
        base = self.at[axis] if self.incremental else self.origin(axis)
        text, value = self.number((place - base) / self.unit(), decimals)
        return "XYZ"[axis] + text, base + value * self.unit()

    def feed_words(self, length, own=False):
        if self.feed_mode == 93:
            text, _ = self.number(min(9000.0, self.r.uniform(50, 3000) / max(length, 0.5)) + 0.01, 3)
        elif own or not self.has_feed or self.r.random() < 0.2:
            speed = self.r.uniform(50, 3000) if self.feed_mode == 94 else self.r.uniform(0.05, 1.0)
            text, _ = self.number(max(speed / self.unit(), 0.01), self.r.choice([1, 3]) if self.feed_mode == 94 else 4)
        else:
            return []
        self.has_feed = True
        return ["F" + text]

    def motion_words(self, code):
        if self.motion == code and not self.repeat and self.r.random() < 0.6:
            return []
        self.motion = code
        return [self.code(code)]

    def somewhere(self, axis):
        r = self.r
        near = r.random() < 0.3
        return self.at[axis] + r.gauss(0, 0.5) if near else r.uniform(-120, 120)

    def mode_words(self):
        """Sometimes modal words, for a block of their own or beside a motion."""
        r = self.r
        words = []
        if r.random() < 0.08:
            self.incremental = not self.incremental
            words.append("G91" if self.incremental else "G90")
        if r.random() < 0.08:
            self.absolute_centre = not self.absolute_centre
            words.append("G90.1" if self.absolute_centre else "G91.1")
        if r.random() < 0.15:
            self.plane = r.choice([17, 18, 19])
            words.append(f"G{self.plane}")
        if r.random() < 0.04:
            self.inch = not self.inch
            words.append("G20" if self.inch else "G21")
            self.has_feed = self.has_feed and self.feed_mode == 93
        if r.random() < 0.04:
            self.system = r.randrange(9)
            words.append(["G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"][self.system])
        return words

    def beside_words(self):
        """Sometimes M codes that act before or after the motion of their block."""
        return self.r.choice([["M8"], ["M9"], ["M5"], ["M3"], ["M1"], ["M8", "M5"], ["M9", "M0"]]) if self.r.random() < 0.05 else []

    def straight(self):
        r = self.r
        before = self.inch
        modes = self.mode_words()
        rapid = r.random() < 0.25 or self.height_unknown
        axes = r.sample(range(3), r.choice([1, 2, 2, 3]))
        if 2 in axes and not self.incremental:
            self.height_unknown = False
        words, to = [], list(self.at)
        for axis in axes:
            word, to[axis] = self.coordinate(axis, self.somewhere(axis))
            words.append(word)
        feed = [] if rapid and (r.random() < 0.9 or self.feed_mode == 93) else self.feed_words(math.dist(self.at, to))
        if feed and self.inch != before and self.feed_mode != 93:
            # F beside a change of units is read differently: the units go into a block before.
            modes = self.alone(modes, ("G20", "G21"))
        motion = self.motion_words(0 if rapid else 1)
        if motion and r.random() < 0.03:
            motion += ["G4", "P0.1"]
        self.block(modes + motion + words + feed + self.beside_words())
        self.at = to

    def alone(self, modes, codes):
        first = [word for word in modes if word in codes]
        if first:
            self.block(first)
        return [word for word in modes if word not in codes]

    def arc(self):
        if self.height_unknown:
            return
        r = self.r
        before = self.inch
        modes = self.mode_words()
        first, second, normal = {17: (0, 1, 2), 18: (2, 0, 1), 19: (1, 2, 0)}[self.plane]
        clockwise = r.random() < 0.5
        decimals = 5 if self.inch else 4
        radius = math.exp(r.uniform(math.log(0.3), math.log(60)))
        angle = r.uniform(0, 2 * math.pi)
        full = r.random() < 0.15
        sweep = 2 * math.pi if full else r.choice([r.uniform(0.02, 6.2), r.choice([0.5, 1, 1.5]) * math.pi])
        turn = -sweep if clockwise else sweep
        if r.random() < 0.3:
            angle = round(angle / (math.pi / 2)) * math.pi / 2
        centre = [self.at[first] - radius * math.cos(angle), self.at[second] - radius * math.sin(angle)]
        to = list(self.at)
        words = []
        ends = [centre[0] + radius * math.cos(angle + turn), centre[1] + radius * math.sin(angle + turn)]
        if full:
            # Words for a place that is reached exactly, or none.
            if not self.incremental and r.random() < 0.5:
                pass
        else:
            for axis, place in zip((first, second), ends):
                word, to[axis] = self.coordinate(axis, place, decimals)
                words.append(word)
        if r.random() < 0.3:
            word, to[normal] = self.coordinate(normal, self.at[normal] + r.uniform(-5, 5))
            words.append(word)
        chord = math.hypot(to[first] - self.at[first], to[second] - self.at[second])
        if not full and r.random() < 0.4 and chord > 0.05:
            bent = max(radius, chord / 2)
            if bent < chord / 2 * 1.0005:
                bent = chord / 2 * 1.001
            text, _ = self.number(bent / self.unit(), decimals)
            words.append("R" + ("-" + text.lstrip("+") if sweep > math.pi else text))
        else:
            for axis, place in zip((first, second), centre):
                base = self.origin(axis) if self.absolute_centre else self.at[axis]
                text, value = self.number((place - base) / self.unit(), decimals)
                if value == 0 and not self.absolute_centre and r.random() < 0.5 and abs(radius) > 0:
                    continue
                words.append("IJK"[axis] + text)
        feed = self.feed_words(abs(sweep) * radius)
        if feed and self.inch != before and self.feed_mode != 93:
            modes = self.alone(modes, ("G20", "G21"))
        self.block(modes + self.motion_words(2 if clockwise else 3) + words + feed + self.beside_words())
        self.at = to

    def circle_by_end(self):
        """A full circle whose end is written out; possible where the words meet the place exactly."""
        if self.incremental or self.absolute_centre or self.feed_mode == 93 or self.height_unknown:
            return
        first, second, _ = {17: (0, 1, 2), 18: (2, 0, 1), 19: (1, 2, 0)}[self.plane]
        words = []
        for axis in (first, second):
            word, self.at[axis] = self.coordinate(axis, self.somewhere(axis))
            words.append(word)
        self.block(self.motion_words(0) + words)
        text, _ = self.number(self.r.uniform(0.1, 30) / self.unit(), 4)
        self.block(self.motion_words(self.r.choice([2, 3])) + words + ["IJK"[self.r.choice((first, second))] + text] + self.feed_words(1.0))

    def offset_block(self):
        r = self.r
        kind = r.random()
        if kind < 0.5:
            words = []
            for axis in r.sample(range(2), r.choice([1, 2])) if self.height_unknown else r.sample(range(3), r.choice([1, 2, 3])):
                text, value = self.number(r.uniform(-50, 50) / self.unit())
                words.append("XYZ"[axis] + text)
                self.offset[axis] = self.at[axis] - self.origins[self.system][axis] - value * self.unit()
            self.saved = list(self.offset)
            self.block(["G92"] + words)
        elif kind < 0.7:
            self.block([r.choice(["G92.1"])])
            self.offset, self.saved = [0.0] * 3, [0.0] * 3
        elif kind < 0.85 or self.saved is None:
            self.block(["G92.2"])
            self.offset = [0.0] * 3
        else:
            self.block(["G92.3"])
            self.offset = list(self.saved)

    def machine_block(self):
        """To a place of the machine, or another length of the tool."""
        r = self.r
        kind = r.random()
        axes = r.sample(range(3), r.choice([0, 1, 1, 2, 3]))
        words = []
        if kind < 0.4:
            code = r.randrange(2)
            for axis in axes:
                words.append(self.coordinate(axis, self.somewhere(axis))[0])
            self.block([["G28", "G30"][code]] + words)
            self.go_to_machine({axis: REFERENCES_MM[code][axis] for axis in axes or range(3)})
        elif kind < 0.7:
            if self.incremental or not axes:
                return
            places = {}
            for axis in axes:
                text, value = self.number(r.uniform(-120, 120) / self.unit())
                words.append("XYZ"[axis] + text)
                places[axis] = value * self.unit()
            self.block(["G53"] + self.motion_words(0) + words)
            self.go_to_machine(places)
        else:
            before = self.length
            if kind < 0.9:
                text, value = self.number(r.uniform(-60, 60) / self.unit())
                self.length = value * self.unit()
                self.block(["G43.1", "Z" + text])
                self.in_force = True
            else:
                self.length = 0.0
                self.block(["G49"])
            self.height_unknown = self.height_unknown or kind < 0.9 or self.in_force
            self.in_force = kind < 0.9
            self.at[2] += before - self.length

    def go_to_machine(self, places):
        for axis, place in places.items():
            self.at[axis] = place - (self.length if axis == 2 else 0.0)
        if 2 in places:
            self.height_unknown = self.in_force

    def feed_mode_block(self):
        self.feed_mode = self.r.choice([93, 94, 94, 95])
        self.block([f"G{self.feed_mode}"] + (["M3", "S1000"] if self.feed_mode == 95 else []))
        self.has_feed = False

    def other_block(self):
        r = self.r
        if r.random() < 0.2:
            self.block(self.feed_words(1.0, own=True) + r.choice([[], ["M8"], ["G17"]] if self.plane == 17 else [[], ["M9"]]))
            return
        self.block([r.choice(["M3 S1000", "M5", "M8", "M9", "G4 P0.1", "G61", "G64 P0.01", "G64", "M0", "M1", "G40"])], comment=False)

    def program(self):
        r = self.r
        if r.random() < 0.1:
            self.lines.append(r.choice(["(program 1)", "; program", "%"]))
        if self.lines == ["%"]:
            self.lines.append("(tape)")
        self.inch = r.random() < 0.3
        self.block(["G20" if self.inch else "G21", "G90"] + r.choice([[], ["G17"], ["G40", "G49"], ["G94"], ["G54"]]))
        words = []
        for axis in range(3):
            word, self.at[axis] = self.coordinate(axis, r.uniform(-50, 50))
            words.append(word)
        self.block(self.motion_words(0) + words)
        for _ in range(r.randrange(4, 30)):
            kind = r.random()
            if kind < 0.42:
                self.straight()
            elif kind < 0.82:
                self.arc()
            elif kind < 0.86:
                self.circle_by_end()
            elif kind < 0.91:
                self.offset_block()
            elif kind < 0.94:
                self.feed_mode_block()
            elif kind < 0.97:
                self.other_block()
            elif kind < 0.985:
                self.machine_block()
            else:
                modes = self.mode_words()
                if modes:
                    self.block(modes)
        self.block([r.choice(["M2", "M30"])])
        ending = r.choice(["\n", "\n", "\r\n"])
        return ending.join(self.lines) + ending


def mutant(text, seed):
    """The program with one word changed."""
    r = random.Random(seed)
    lines = text.splitlines()
    at = r.randrange(2, len(lines))
    line = lines[at]
    words = ["G0", "G1", "G2", "G3", "G4", "G17", "G18", "G19", "G20", "G21", "G53", "G54", "G59.3", "G61", "G80", "G81"]
    words += ["G28", "G30 Z5", "G53 G0 Z1", "G53 G1 X1", "G43.1 Z3", "G49"]
    words += ["G90", "G91", "G90.1", "G91.1", "G92", "G92.1", "G92.3", "G93", "G94", "G95", "G9", "G98", "G40", "G41", "G43", "G49"]
    words += ["G2.1", "G20.1", "G61.2", "G90.2", "M5", "M9", "M48", "M3.5", "T2"]
    words += ["X1", "Y-2.5", "Z0", "I3", "J-4", "K0", "I0", "R12", "R-30", "R0", "F0", "F50", "F-5", "P2", "P1", "Q1", "S5", "T1", "M2", "M3"]
    # Not M6: after it LinuxCNC takes the position from the machine, and there is none here.
    words += ["M7", "M30", "M60", "M62 P1", "A5", "B1", "U2", "E1", "H0", "D0", "L2", "N5", "X", "G", "1", ".", "X1.2.3", "X--1", "X+1"]
    words += ["(", ")", "(a(b)", ";", "/", "%", "#1=2", "X#1", "X[1+1]", "O5", "*7", ",", "G1.5", "M3.5", "G01.0", "$", "\x0b", "\u00e9"]
    choice = r.randrange(6)
    if choice == 0:
        place = r.randrange(len(line) + 1)
        lines[at] = line[:place] + " " + r.choice(words) + " " + line[place:]
    elif choice == 1:
        lines.insert(at, r.choice(words))
    elif choice == 2 and line:
        place = r.randrange(len(line))
        lines[at] = line[:place] + line[place + 1 :]
    elif choice == 3 and line:
        place = r.randrange(len(line))
        lines[at] = line[:place] + r.choice("GXYZIJKRF0123456789.- ") + line[place + 1 :]
    elif choice == 4:
        del lines[at]
    else:
        other = r.randrange(2, len(lines))
        lines[at], lines[other] = lines[other], lines[at]
    return "\n".join(lines) + "\n"


# --- comparison -----------------------------------------------------------------------------------


class Found:
    """Largest differences, and programs that differ."""

    def __init__(self, name, keep):
        self.name, self.keep = name, keep
        self.largest = collections.defaultdict(float)
        self.counts = collections.Counter()
        self.classes = collections.defaultdict(list)

    def note(self, what, difference, allowed, example):
        self.largest[what] = max(self.largest[what], difference)
        if not difference <= allowed:
            self.differ(what, example)

    def differ(self, what, example):
        self.classes[what].append(example)

    def report(self, shown):
        print(f"\n{self.name}")
        for what, count in sorted(self.counts.items()):
            print(f"  {count:9d}  {what}")
        for what, value in sorted(self.largest.items()):
            print(f"  {value:9.3g}  largest difference of {what}")
        for what, examples in sorted(self.classes.items(), key=lambda item: -len(item[1])):
            print(f"  {len(examples):9d}  DIFFER: {what}")
            for example in examples[:shown]:
                print(f"             {example}")


def sweep_of(start, end, centre, axes, turns):
    """The angle of LinuxCNC's arc, as its trajectory planner finds it."""
    first, second, _ = axes
    a = math.atan2(start[second] - centre[second], start[first] - centre[first])
    b = math.atan2(end[second] - centre[second], end[first] - centre[first])
    if turns < 0:
        while b - a > -1e-6:
            b -= 2 * math.pi
    else:
        while b - a < 1e-6:
            b += 2 * math.pi
    return b - a + 2 * math.pi * (turns + 1 if turns < 0 else turns - 1)


def compare_moves(found, moves, events, name, source):
    """Move by move; `source` are the program's lines."""
    lines = {move["line"] for move in moves}
    kept, here = [], [0.0] * 3
    for event in events:
        # A motion word without axes is a move without length to LinuxCNC and none to kinetostat.
        if event[0] in lines or math.dist(event[2], here) > PLACE_MM:
            kept.append(event)
        here = event[2]
    # G28 and G30 are two moves to LinuxCNC; the first goes to a point on the way.
    machine = {move["line"] for move in moves if move["machine"]}
    pairs = zip(kept, kept[1:] + [[None]])
    events = [event for event, after in pairs if event[0] not in machine or after[0] != event[0]]
    if len(moves) != len(events):
        found.differ("the number of moves", f"{name}: {len(moves)} and {len(events)}")
        return
    here, shift = None, [0.0] * 3
    for move, (line, kind, end, feed, arc) in zip(moves, events):
        text = source[line - 1].strip() if 0 < line <= len(source) else ""
        example = f"{name}:{line}: {text}"
        found.counts["moves compared"] += 1
        if move["line"] != line or move["kind"] != kind:
            found.differ("line or kind of a move", example + f" ({move['line']} {move['kind']})")
            return
        known, shift = shift, stated_places(shift, move["end"], end, source[: line - 1])
        here = here and tuple(here[axis] + shift[axis] - known[axis] for axis in range(3))
        end = tuple(end[axis] + shift[axis] for axis in range(3))
        axes = 3
        if move["knowledge"] == "nothing" and (not move["machine"] or has_tool_length(source[:line])):
            found.counts["moves without a known height compared in X and Y"] += 1
            axes = 2
        elif move["machine"]:
            found.counts["moves to places of the machine compared"] += 1
        found.note("end point, mm", math.dist(move["end"][:axes], end[:axes]), PLACE_MM, example)
        if (move["arc"] is None) != (arc is None):
            found.differ("arc or straight", example)
            return
        if arc is not None and here is not None:
            found.counts["arcs compared"] += 1
            axes, centre, turns = arc
            centre = tuple(centre[axis] + shift[axis] for axis in range(3))
            mine = move["arc"]
            off = math.hypot(*(mine["centre"][axis] - centre[axis] for axis in axes[:2]))
            found.note("arc centre, mm", off, PLACE_MM, example)
            if mine["axis"][axes[2]] != 1.0:
                found.differ("plane of an arc", example)
            sweep = sweep_of(here, end, centre, axes, turns)
            if (sweep > 0) != (mine["sweep"] > 0):
                found.differ("sense of an arc", example)
            radius = math.dist(centre, here) or 1.0
            off = abs(sweep - mine["sweep"])
            found.note("sweep of an arc, mm along it", off * radius, 1e-5, example + f" {sweep} {mine['sweep']}")
        if kind == "feed" and move["feed"] is None:
            # Before the first F the speed is the machine's: kinetostat warns.
            found.counts["feed moves before the first F"] += 1
        elif kind == "feed":
            mode, value = move["feed"]
            if mode == "G93":
                # LinuxCNC turns inverse time into a speed, at least 0.1 units in a minute.
                length = move["length"]
                if arc is not None:
                    # It measures an arc with the radius of its start.
                    length = math.hypot(math.hypot(*(here[axis] - centre[axis] for axis in axes[:2])) * mine["sweep"], mine["rise"])
                wanted = length * value
                if wanted > 0.2 * MM:
                    found.counts["feeds compared (G93)"] += 1
                    found.note("feed, relative", abs(feed / wanted - 1), 1e-9, example + f" {feed} {wanted}")
            else:
                found.counts["feeds compared"] += 1
                found.note("feed, relative", abs(feed / value - 1), 1e-9, example + f" {feed} {value}")
        if "part" in move and kind == "feed" and move["programmed"] and move["known"]:
            check_speed(found, move, feed, example)
        here = end


def has_tool_length(lines):
    """Whether a tool's length is in force after these lines."""
    codes = [code for line in lines for code in re.findall(r"G(43\.1|49)(?![.0-9])", re.sub(r"\([^)]*\)|;.*", "", line).upper())]
    return codes[-1:] == ["43.1"]


def stated_places(shift, mine, theirs, before):
    """For LinuxCNC every axis stands at its zero before the program; for kinetostat a first G92 says where an
    axis stands that has not been moved yet. From there on their places differ by what that G92 states: one
    constant for each such axis, taken from the first move after it."""
    new = list(shift)
    for axis, letter in enumerate("XYZ"):
        off = mine[axis] - theirs[axis] - shift[axis]
        words = [line.upper() for line in before if letter in line.upper()]
        first = re.sub(r"\([^)]*\)|;.*", "", words[0]) if words else ""
        if shift[axis] == 0.0 and abs(off) > PLACE_MM and re.search(r"G92(?![.0-9])", first):
            new[axis] = off
    return new


def check_speed(found, move, feed, example):
    """The promise of the writer: the programmed speed along the part, as LinuxCNC will drive it."""
    mode, programmed = move["programmed"]
    if mode == "G93":
        programmed *= move["whole"]
        if feed < 0.2 * MM:
            return
    if move["length"] > 1e-6 and move["part"] > 0 and not move["step"]:
        speed = feed * move["part"] / move["length"]
        if move["limited"]:
            # The feed was held to a stated multiple of the programmed one: slower, never faster.
            found.counts["feeds held to their limit"] += 1
            speed = max(speed, programmed)
        found.note("speed along the part, relative", abs(speed / programmed - 1), 1e-3, example + f" {speed} {programmed}")


def run_geometry(tools, folder, count, seed, offsets):
    found = Found(f"moves of {count} random programs" + (", work offsets" if offsets else ""), folder)
    parameters = folder / "parameters.var"
    write_parameters(parameters, offsets)
    names = []
    for index in range(count):
        writer = Writer(seed * 1_000_003 + index)
        if offsets:
            writer.origins = [(12.7 * k, -2.54 * (k + 1), 0.254 * k * k) for k in range(9)]
        name = folder / f"r{seed}-{index}.ngc"
        name.write_bytes(writer.program().encode())
        names.append(str(name))
    theirs = ask_linuxcnc(tools["python"], names, parameters)
    mine = ask_kinetostat(tools["moves"], names, *(["--offsets"] if offsets else []))
    both = []
    for name in names:
        verdict(found, name, mine[name]["error"], theirs[name])
        if mine[name]["error"] is None and theirs[name]["error"] is None:
            both.append(name)
            compare_moves(found, mine[name]["moves"], theirs[name]["events"], name, pathlib.Path(name).read_text().splitlines())
    found.counts["programs"] += len(names)
    return found, both


def verdict(found, name, mine, their):
    if (mine is None) == (their["error"] is None):
        found.counts["accepted by both" if mine is None else "refused by both"] += 1
    elif mine is None:
        # A line that cannot be read at all is counted as the one before.
        near = [line.strip() for line in pathlib.Path(name).read_text(errors="replace").splitlines()][max(their["line"] - 1, 0) :][:2]
        found.differ("only LinuxCNC refuses: " + their["error"].split(":")[0], f"{name}:{their['line']}: {' | '.join(near)}")
    else:
        reason = mine.split("`: ", 1)[-1]
        reason = "".join("#" if letter.isdigit() else letter for letter in reason)
        found.differ("only kinetostat refuses: " + reason[:90], f"{name}: {mine[:150]}")


def run_mutants(tools, folder, count, seed):
    found = Found(f"{count} programs with one word changed", folder)
    parameters = folder / "parameters.var"
    write_parameters(parameters, False)
    names = []
    for index in range(count):
        name = folder / f"m{seed}-{index}.ngc"
        name.write_bytes(mutant(Writer(seed * 7_000_003 + index).program(), index).encode())
        names.append(str(name))
    theirs = ask_linuxcnc(tools["python"], names, parameters)
    mine = ask_kinetostat(tools["moves"], names)
    for name in names:
        verdict(found, name, mine[name]["error"], theirs[name])
        if mine[name]["error"] is None and theirs[name]["error"] is None:
            compare_moves(found, mine[name]["moves"], theirs[name]["events"], name, pathlib.Path(name).read_text(errors="replace").splitlines())
    return found


def run_corrected(tools, folder, names, field, offsets=False):
    """In batches: a program becomes some thousand pieces."""
    found = Found(f"{len(names)} programs written with the field `{field}`" + (", work offsets" if offsets else ""), folder)
    parameters = folder / "parameters.var"
    write_parameters(parameters, offsets)
    output = folder / f"corrected-{field}{'-offsets' if offsets else ''}"
    output.mkdir(exist_ok=True)
    for first in range(0, len(names), 100):
        correct_batch(found, tools, names[first : first + 100], field, output, parameters, offsets)
    found.counts["programs"] += len(names)
    return found


def correct_batch(found, tools, names, field, output, parameters, offsets):
    mine = ask_kinetostat(tools["moves"], names, "--correct", field, str(output), *(["--offsets"] if offsets else []))
    written = {}
    for name in names:
        if mine[name]["error"] is not None:
            found.differ("not written: " + mine[name]["error"][:80], name)
        else:
            written[str(output / pathlib.Path(name).name)] = mine[name]["moves"]
    theirs = ask_linuxcnc(tools["python"], list(written), parameters)
    for name, pieces in written.items():
        source = pathlib.Path(name).read_bytes().decode(errors="replace").splitlines()
        if theirs[name]["error"] is not None:
            line = theirs[name]["line"]
            near = " | ".join(text.strip() for text in source[max(line - 1, 0) :][:2])
            found.differ("LinuxCNC refuses what was written: " + theirs[name]["error"].split(":")[0], f"{name}:{line}: {near}")
        else:
            compare_moves(found, pieces, theirs[name]["events"], name, source)
        if tools["rs274"] and not accepted_by_rs274(tools["rs274"], name, parameters):
            # It reads the offsets of the parameter file in other units, so an arc whose block changes the
            # coordinate system may have no centre to it: then it refuses the input as well.
            input_name = next(one for one in names if pathlib.Path(one).name == pathlib.Path(name).name)
            if accepted_by_rs274(tools["rs274"], input_name, parameters):
                found.differ("rs274 refuses what was written", name)
            else:
                found.counts["refused by rs274 as the input is"] += 1
        elif tools["rs274"]:
            found.counts["accepted by rs274"] += 1


def with_end(program, folder):
    """A copy that ends as LinuxCNC wants it: without M2, M30 or % it refuses the file itself."""
    text = program.read_bytes()
    words = [line.split(b";")[0].split(b"(")[0].upper().split() for line in text.splitlines()]
    ended = any(word in (b"M2", b"M02", b"M30", b"%") for line in words for word in line)
    copy = folder / program.name
    copy.write_bytes(text if ended else text.rstrip() + b"\nM2\n")
    return str(copy)


def accepted_by_rs274(rs274, name, parameters):
    used = str(parameters) + ".rs274"
    shutil.copyfile(parameters, used)  # it writes the file when it ends
    for _ in range(3):  # two at a time disturb each other: they share the memory of the tool table
        done = subprocess.run([rs274, "-g", "-v", used, name], capture_output=True, text=True, errors="replace", stdin=subprocess.DEVNULL)
        if done.returncode == 0 and "PROGRAM_END" in done.stdout:
            return True
    return False


def main():
    if sys.argv[1:2] == ["--worker"]:
        return worker(sys.argv[2])
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=int, default=2000, help="random programs to compare (half as many again with work offsets)")
    parser.add_argument("--mutants", type=int, default=2000, help="programs with one word changed")
    parser.add_argument("--corrected", type=int, default=500, help="random programs to write with corrections")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the programs; otherwise they are removed")
    parser.add_argument("--lines", type=int, default=3, help="examples shown of each difference")
    parser.add_argument("--moves", type=pathlib.Path, help="the example `moves`, if it is built already")
    parser.add_argument("program", nargs="*", type=pathlib.Path, help="real programs to write with corrections")
    options = parser.parse_args()
    python = linuxcnc_python()
    if python is None:
        print("SKIPPED: LinuxCNC's Python module `gcode` is not installed (Debian: linuxcnc-uspace); nothing was compared")
        return 0
    tools = {"python": python, "moves": options.moves or build_moves(), "rs274": shutil.which("rs274")}
    if tools["rs274"] is None:
        print("rs274 is not installed: written programs are read by the module gcode alone")
    folder = options.keep or pathlib.Path(tempfile.mkdtemp())
    folder.mkdir(parents=True, exist_ok=True)
    failed = False
    try:
        plain, names = run_geometry(tools, folder, options.programs, options.seed, False)
        plain.report(options.lines)
        shifted, shifted_names = run_geometry(tools, folder, options.programs // 2, options.seed + 1, True)
        shifted.report(options.lines)
        run_mutants(tools, folder, options.mutants, options.seed).report(options.lines)
        failed = bool(plain.classes or shifted.classes)
        real = [with_end(program, folder) for program in options.program]
        for field in ("none", "smooth", "jumps"):
            for chosen, offsets in ((names[: options.corrected] + real, False), (shifted_names[: options.corrected // 4], True)):
                found = run_corrected(tools, folder, chosen, field, offsets)
                found.report(options.lines)
                failed = failed or bool(found.classes)
    finally:
        if options.keep is None:
            shutil.rmtree(folder)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
