"""The tools of LinuxCNC, which its interpreter expects in memory that it shares with a running machine."""

import ctypes
import glob
import os
import pathlib
import shutil
import subprocess


def libraries(pattern):
    folders = os.environ.get("LD_LIBRARY_PATH", "").split(":") + ["/usr/lib"]
    return [name for folder in folders if folder for name in sorted(glob.glob(f"{folder}/{pattern}"))]


def standalone():
    """LinuxCNC's interpreter as a program, if it is there."""
    nearby = [str(pathlib.Path(name).parent.parent / "bin") for name in libraries("librs274.so.0")]
    return shutil.which("rs274", path=os.pathsep.join([os.environ.get("PATH", ""), *nearby]))


def environment_with_tools(folder, diameters):
    """The environment of a worker that loads the tools, by number with their diameters; files lie in the folder."""
    home = folder / "home"
    home.mkdir(parents=True, exist_ok=True)
    table = folder / "tool.tbl"
    table.write_text("".join(f"T{n} P{n} D{d} Z0\n" for n, d in sorted(diameters.items())))
    (folder / "empty.ngc").write_text("M2\n")
    environment = dict(os.environ, HOME=str(home))
    if rs274 := standalone():
        # It leaves the memory of the tools behind (`.tool.mmap`).
        command = [rs274, "-g", "-t", str(table), str(folder / "empty.ngc")]
        subprocess.run(command, env=environment, cwd=folder, capture_output=True, timeout=60)
    return environment


def load_tools():
    """In a worker: without the tools in memory every M6 and G43 ends the process."""
    if (pathlib.Path.home() / ".tool.mmap").exists():
        for library in libraries("libtooldata.so.0"):
            ctypes.CDLL(library, mode=ctypes.RTLD_GLOBAL)._Z14tool_mmap_userv()
            break
