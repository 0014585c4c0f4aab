#!/usr/bin/env python3
"""Every file of LinuxCNC's tree of programs: taken by `expand` or refused, and what LinuxCNC itself says.

    validation/scripts/nc_files_with_linuxcnc.py [--tree FOLDER] [--write] [--keep FOLDER] [--expand FILE] [PROGRAM ...]

Writes (`--write`) or checks the table docs/linuxcnc-nc_files.csv: file, class, what kinetostat says without and with what the
machine knows (units, where the tool is, offsets, diameters of tools, other axes stand still, the dialect), and LinuxCNC's
verdict. Of each program that both take, the canonical moves of the program and of the flat one must be the same to 1e-9 mm.
With PROGRAM, only these are compared, outside the table.

The tree is that of Debian's linuxcnc-uspace: /usr/share/linuxcnc/ncfiles, or LINUXCNC_NC_FILES. LinuxCNC's module `gcode`
runs in a process of its own; without it (or the tree) the script says what it leaves out and ends with 0. Exit status 1: a
difference, a row that is no longer true, or a file that is refused without a reason in the table.
"""

import argparse
import collections
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from linuxcnc_tools import environment_with_tools, load_tools

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE = ROOT / "docs" / "linuxcnc-nc_files.csv"
MM = 25.4
PLACE_MM = 1e-9
MOST_MOVES = 400_000
PROGRAMS = {".ngc", ".nc", ".gcode", ".tap"}


# --- the side of LinuxCNC: a process of its own ---------------------------------------------------


class Canon:
    """Takes the calls of LinuxCNC's interpreter down as places of the machine in mm."""

    def __init__(self, parameter_file, diameters):
        self.parameter_file = parameter_file
        self.diameters = diameters
        self.g5x = self.g92 = (0.0,) * 3
        self.turned = 0.0
        self.plane, self.feed, self.line, self.loaded = 1, 0.0, 0, 0
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

    def set_xy_rotation(self, angle):
        self.turned = angle

    def set_plane(self, plane):
        self.plane = plane

    def set_feed_rate(self, feed):
        self.feed = feed

    def place(self, xyz):
        import math

        at = [xyz[axis] + self.g92[axis] for axis in range(3)]
        sine, cosine = math.sin(math.radians(self.turned)), math.cos(math.radians(self.turned))
        at[0], at[1] = at[0] * cosine - at[1] * sine, at[0] * sine + at[1] * cosine
        return [(at[axis] + self.g5x[axis]) * MM for axis in range(3)]

    def note(self, kind, xyz, others, feed, arc=None):
        if len(self.events) >= MOST_MOVES:
            raise RuntimeError("too many moves")
        self.events.append([kind, self.place(xyz), list(others), feed, arc])

    def straight_traverse(self, *to):
        self.note("rapid", to[:3], to[3:], 0.0)

    def straight_feed(self, *to):
        self.note("feed", to[:3], to[3:], self.feed * MM)

    def rigid_tap(self, *to):
        self.note("tap", to[:3], [], 0.0)

    def straight_probe(self, *to):
        self.note("probe", to[:3], to[3:], 0.0)

    def arc_feed(self, first, second, centre_first, centre_second, turns, end, *others):
        axes = {1: (0, 1, 2), 2: (1, 2, 0), 3: (2, 0, 1)}[self.plane]
        to, centre = [0.0] * 3, [0.0] * 3
        for axis, at, about in zip(axes, (first, second, end), (centre_first, centre_second, end)):
            to[axis], centre[axis] = at, about
        self.note("arc", to, others, self.feed * MM, [list(axes), self.place(centre), turns])

    def change_tool(self, index):
        self.loaded = index

    def get_tool(self, index):
        number = self.loaded if index == 0 else index
        if not 0 <= number <= 99:
            return (-1,) + (0.0,) * 12 + (0,)
        return (number, 0.0, 0.0) + (0.0,) * 7 + (self.diameters.get(number, 0.0), 0.0, 0.0, 0)

    def get_external_angular_units(self):
        return 1.0

    def get_external_length_units(self):
        return 1.0

    def get_axis_mask(self):
        return 0o777

    def get_block_delete(self):
        return 0


def worker(folder, diameters):
    """One program for each line of the standard input: name, tab, folders of subprograms."""
    name, subprograms = sys.stdin.read().rstrip("\n").split("\t")
    parameters = folder / "parameters.var"
    values = {number: 0.0 for number in [*range(5161, 5170), *range(5181, 5190), *range(5210, 5220)]}
    values[5220] = 1.0
    values.update({5221 + 20 * system + index: 0.0 for system in range(9) for index in range(10)})
    parameters.write_text("".join(f"{number}\t{value:.15f}\n" for number, value in sorted(values.items())))
    ini = folder / "machine.ini"
    ini.write_text(
        f"[EMC]\n[RS274NGC]\nSUBROUTINE_PATH = {subprograms}\nPARAMETER_FILE = {parameters}\nFEATURES = 28\n[PYTHON]\n"
        f"[EMCIO]\nTOOL_TABLE = {folder}/tool.tbl\n[TRAJ]\nCOORDINATES = X Y Z A B C U V W\nLINEAR_UNITS = mm\n"
    )
    os.environ["INI_FILE_NAME"] = str(ini)
    load_tools()
    import gcode  # LinuxCNC's; only ever loaded in this process

    canon = Canon(str(parameters), diameters)
    os.chdir(folder)
    try:
        result, line = gcode.parse(name, canon, "G21", "G49")
        error = gcode.strerror(result) if result > gcode.MIN_ERROR else None
    except Exception as problem:  # the interpreter raises all kinds
        error, line = str(problem), canon.line
    print("\n" + json.dumps({"error": error, "line": line, "events": canon.events}), flush=True)


def linuxcnc_python():
    for folder in os.environ.get("PATH", "").split(os.pathsep):
        python = shutil.which("python3", path=folder)
        if python and subprocess.run([python, "-c", "import gcode; gcode.parse"], capture_output=True).returncode == 0:
            return python
    return None


class LinuxCnc:
    def __init__(self, python, folder, diameters):
        self.python, self.folder, self.diameters = python, folder, diameters
        self.environment = environment_with_tools(folder, diameters)

    def ask(self, name, subprograms):
        command = [self.python, __file__, "--worker", str(self.folder), json.dumps(self.diameters)]
        text = f"{name}\t{':'.join(map(str, subprograms))}"
        try:
            done = subprocess.run(command, input=text, capture_output=True, text=True, errors="replace", env=self.environment, timeout=60)
        except subprocess.TimeoutExpired:
            return {"error": "it does not end", "line": 0, "events": []}
        for line in reversed(done.stdout.splitlines()):
            if line.startswith('{"error"'):
                return json.loads(line)
        return {"error": f"the process ended with {done.returncode}", "line": 0, "events": []}


# --- comparing -----------------------------------------------------------------------------------


def moves(events):
    """Moves with a length."""
    made, last = [], None
    for kind, end, others, feed, arc in events:
        if kind == "tap":
            # Kinetostat writes it as a feed there and back, as fast as the pitch wants it.
            made += [("feed", end, last[3:], None, None), ("feed", last[:3], last[3:], None, None)]
            continue
        here = end + others
        if arc is None and last is not None and len(last) == len(here) and max(abs(a - b) for a, b in zip(here, last)) < PLACE_MM:
            continue
        made.append((kind, end, others, feed, arc))
        last = here
    return made


def difference(one, other):
    """What is different between two rows of moves, and the largest distance."""
    worst = 0.0
    for index, ((kind, end, others, feed, arc), (kind2, end2, others2, feed2, arc2)) in enumerate(zip(one, other)):
        if kind != kind2:
            return f"move {index} is {kind} {end}, flat {kind2} {end2}", worst
        apart = max(abs(a - b) for a, b in zip(end + others, end2 + others2))
        if arc is not None:
            if arc[0] != arc2[0] or arc[2] != arc2[2]:
                return f"move {index} turns {arc}, flat {arc2}", worst
            apart = max(apart, *(abs(arc[1][axis] - arc2[1][axis]) for axis in arc[0][:2]))
        worst = max(worst, apart)
        if not apart <= PLACE_MM:
            return f"move {index} is {apart:.3e} mm away: {end} {others} {arc}, flat {end2} {others2} {arc2}", worst
        if feed is not None and abs(feed - feed2) > 1e-9 * max(feed, 1.0):
            return f"move {index} has the feed {feed}, flat {feed2}", worst
    if len(one) != len(other):
        return f"{len(one)} moves, {len(other)} flat ones", worst
    return None, worst


def build_expand():
    command = ["cargo", "build", "-q", "-j2", "-p", "kinetostat-program", "--example", "expand", "--message-format=json"]
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True)
    for line in done.stdout.splitlines():
        item = json.loads(line)
        if item.get("executable") and item["target"]["name"] == "expand":
            return item["executable"]
    raise SystemExit("cargo built no example `expand`")


class Expand:
    def __init__(self, binary, folders, diameters):
        self.binary, self.folders, self.diameters = binary, folders, diameters

    def ask(self, name, flat, with_machine):
        """The flat program's bytes, or the refusal."""
        command = [self.binary]
        if with_machine:
            command += ["--as-linuxcnc", "--dialect", "linuxcnc"]
        for number, diameter in sorted(self.diameters.items()):
            command += ["--diameter", f"{number}={diameter}"] if with_machine else []
        command += [str(name), *map(str, self.folders)]
        done = subprocess.run(command, capture_output=True, timeout=120)
        if done.returncode == 0:
            flat.write_bytes(done.stdout)
            return None
        text = done.stderr.decode(errors="replace")
        found = {key: re.search(key + r': (\d+|"(?:[^"\\]|\\.)*")', text) for key in ("line", "reason", "remedy")}
        values = {key: json.loads(match.group(1)) if match else text.strip() for key, match in found.items()}
        return f"line {values['line']}: {values['reason']}"


def compare(linuxcnc, expand, name, folder):
    """Verdicts of one program: kinetostat without and with the machine, LinuxCNC, what differs."""
    flat = folder / "flat.ngc"
    bare = expand.ask(name, flat, False)
    full = expand.ask(name, flat, True)
    if linuxcnc is None:
        return bare, full, None, None, 0, 0.0
    theirs = linuxcnc.ask(name, expand.folders)
    if full is not None or theirs["error"] is not None:
        return bare, full, theirs, None, 0, 0.0
    again = linuxcnc.ask(flat, [])
    if again["error"] is not None:
        return bare, full, theirs, f"LinuxCNC refuses the flat program: line {again['line']}: {again['error']}", 0, 0.0
    one = moves(theirs["events"])
    what, worst = difference(one, moves(again["events"]))
    return bare, full, theirs, what, len(one), worst


# --- the tree ------------------------------------------------------------------------------------


def verdict(theirs):
    if theirs is None:
        return ""
    if theirs["error"] is not None:
        return f"refused at line {theirs['line']}: {theirs['error']}".strip()
    return "runs" if theirs["events"] else "runs, nothing moves"


def known_classes():
    if not TABLE.exists():
        return {}
    with TABLE.open(newline="") as table:
        return {row["file"]: row for row in csv.DictReader(table)}


COLUMNS = ["file", "class", "kinetostat", "reason", "because", "without_options", "linuxcnc"]

# Reasons that docs/linuxcnc.md, section 13, names.
DOCUMENTED = [
    (r"the file defines .* nothing is run", "library: nothing is run, 13.1"),
    (r"probing", "probing, 13.2"),
    (r"lathe cycles", "lathe cycle, 13.3"),
    (r"threading", "motion tied to the spindle, 13.4"),
    (r"#<_hal\[", "values of a running machine, 13.5"),
]


def because(row):
    """Why a refusal is right."""
    if row["kinetostat"] != "refused":
        return ""
    if row["linuxcnc"].startswith("refused"):
        return "LinuxCNC refuses it too"
    return next((text for pattern, text in DOCUMENTED if re.search(pattern, row["reason"])), "")


def survey(tree, linuxcnc, expand, folder, write):
    rows, wrong = [], []
    known = known_classes()
    counts = collections.Counter()
    compared, largest = 0, 0.0
    for path in sorted(name for name in tree.rglob("*") if name.is_file()):
        name = str(path.relative_to(tree))
        row = dict(file=name, **{"class": known.get(name, {}).get("class", "?")})
        if path.suffix.lower() not in PROGRAMS:
            row.update({"class": "no program", "kinetostat": "no program", "reason": "not G-code: " + (path.suffix or "no ending"), "because": "", "without_options": "", "linuxcnc": ""})
            rows.append(row)
            continue
        bare, full, theirs, what, count, worst = compare(linuxcnc, expand, path, folder)
        row["kinetostat"] = "refused" if full else "taken"
        row["reason"] = full or ""
        row["without_options"] = bare and "refused" or "taken"
        row["linuxcnc"] = verdict(theirs) if theirs else known.get(name, {}).get("linuxcnc", "")
        row["because"] = because(row)
        if full and not row["because"]:
            wrong.append(f"{name}: refused without a reason that LinuxCNC shares or the documentation names: {full}")
        compared, largest = compared + count, max(largest, worst)
        if what is not None:
            wrong.append(f"{name}: {what}")
        elif full is None and row["linuxcnc"].startswith("refused"):
            counts["taken, refused by LinuxCNC"] += 1
            print(f"  only LinuxCNC refuses {name}: {row['linuxcnc']}")
        rows.append(row)
        counts[row["class"], row["kinetostat"]] += 1
        counts[row["class"], "without options", row["without_options"]] += 1
    for kind in sorted({row["class"] for row in rows}):
        taken, refused = counts[kind, "taken"], counts[kind, "refused"]
        bare = counts[kind, "without options", "taken"]
        if taken + refused:
            print(f"  {kind}: {taken} of {taken + refused} taken, {bare} without options")
    if linuxcnc is not None:
        print(f"  {compared} moves of programs compared with LinuxCNC's, largest difference {largest:.2e} mm")
        figure = dict(name="LinuxCNC's nc_files, expanded: canonical moves beside LinuxCNC's own", measured=largest, asked=f"at most {PLACE_MM}", unit="mm", holds=bool(compared) and not wrong)
        print("figure " + json.dumps(figure))
    for row in rows:
        if not write and row["file"] not in known:
            wrong.append(f"{row['file']} is not in {TABLE.name}")
        elif not write:
            for column in ("kinetostat", "reason", "because", "without_options"):
                if known[row["file"]][column] != row.get(column, ""):
                    wrong.append(f"{row['file']}: {column} is '{row.get(column, '')}', the table says '{known[row['file']][column]}'")
    if write:
        with TABLE.open("w", newline="") as table:
            writer = csv.DictWriter(table, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    return wrong


def tree_folder(named):
    for folder in (named, os.environ.get("LINUXCNC_NC_FILES"), "/usr/share/linuxcnc/ncfiles"):
        if folder and pathlib.Path(folder).is_dir():
            return pathlib.Path(folder)
    return None


def unpacked_libraries(tree):
    """A package that was unpacked, not installed: its libraries lie beside its programs."""
    if tree is None or tree.parts[-4:] != ("usr", "share", "linuxcnc", "ncfiles"):
        return
    usr = tree.parents[2]
    found = [usr / "lib", *usr.glob("lib/*-linux-gnu")]
    os.environ["LD_LIBRARY_PATH"] = ":".join([os.environ.get("LD_LIBRARY_PATH", ""), *map(str, found)]).strip(":")
    modules = usr / "lib" / "python3" / "dist-packages"
    os.environ["PYTHONPATH"] = f"{os.environ.get('PYTHONPATH', '')}:{modules}".strip(":")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", nargs="*", type=pathlib.Path, metavar="PROGRAM")
    parser.add_argument("--tree", type=pathlib.Path)
    parser.add_argument("--write", action="store_true", help="writes the table")
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--expand", type=pathlib.Path, help="the example `expand`, if it is built already")
    options = parser.parse_args()
    tree = tree_folder(options.tree)
    unpacked_libraries(tree)
    python = linuxcnc_python()
    if python is None:
        print("SKIPPED: LinuxCNC's Python module `gcode` is not installed (Debian: linuxcnc-uspace); nothing was compared with it")
    if tree is None and not options.programs:
        print("SKIPPED: LinuxCNC's nc_files are not here (Debian: linuxcnc-uspace; or LINUXCNC_NC_FILES)")
        return 0
    folder = options.keep or pathlib.Path(tempfile.mkdtemp())
    folder.mkdir(parents=True, exist_ok=True)
    # Small enough for the contours of all programs of the tree.
    diameters = {number: round(0.1 * number, 3) for number in range(1, 100)}
    folders = sorted({path.parent for path in tree.rglob("*.ngc")}) if tree else []
    expand = Expand(str(options.expand or build_expand()), folders, diameters)
    linuxcnc = LinuxCnc(python, folder.resolve(), diameters) if python else None
    wrong = []
    try:
        if options.programs:
            for name in options.programs:
                bare, full, theirs, what, count, worst = compare(linuxcnc, expand, name.resolve(), folder)
                print(f"{name}: kinetostat {full or 'takes it'}; LinuxCNC {verdict(theirs)}; {count} moves compared, {worst:.1e} mm")
                wrong += [f"{name}: {what}"] * (what is not None)
        else:
            print(f"{tree}")
            wrong = survey(tree, linuxcnc, expand, folder, options.write)
    finally:
        if options.keep is None:
            shutil.rmtree(folder)
    for line in wrong:
        print("WRONG " + line)
    return int(bool(wrong))


if __name__ == "__main__":
    if sys.argv[1:2] == ["--worker"]:
        worker(pathlib.Path(sys.argv[2]), {int(key): value for key, value in json.loads(sys.argv[3]).items()})
    else:
        sys.exit(main())
