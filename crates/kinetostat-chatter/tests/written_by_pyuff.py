"""Universal files by pyuff (PyPI, MIT), which nobody here wrote: writes those that the tests read, or reads one back as CSV.

    python written_by_pyuff.py write DIRECTORY
    python written_by_pyuff.py read FILE
"""

import sys

import numpy as np
import pyuff


def receptance(f):
    """Two modes at 35 and 80 Hz, m/N: the curve that the tests know as well."""
    w = 2 * np.pi * f
    total = np.zeros(len(f), dtype=complex)
    for hz, zeta, constant in ((35.0, 0.02, 0.05), (80.0, 0.01, -0.02)):
        w0 = 2 * np.pi * hz
        total += constant / (w0**2 - w**2 + 2j * zeta * w0 * w)
    return total


def write(directory):
    even = np.arange(5.0, 120.0, 0.5)
    uneven = np.geomspace(5.0, 120.0, 151)
    cases = {
        # name: frequencies, kind of the ordinate, unit, values in that unit, even, double
        "even_double": (even, 8, "m", receptance(even), True, "double"),
        "even_single": (even, 8, "mm", 1e3 * receptance(even), True, "single"),
        "uneven_double": (uneven, 12, "m/s^2", -((2 * np.pi * uneven) ** 2) * receptance(uneven), False, "double"),
        "uneven_single": (uneven, 11, "mm/s", 2e3j * np.pi * uneven * receptance(uneven), False, "single"),
    }
    for name, (f, kind, unit, values, is_even, precision) in cases.items():
        data = pyuff.prepare_58(
            binary=0,
            func_type=4,
            rsp_node=7,
            rsp_dir=2,
            ref_node=3,
            ref_dir=-1,
            data=values,
            x=f,
            id1="point 7, written by pyuff",
            abscissa_spacing=1 if is_even else 0,
            abscissa_min=f[0],
            abscissa_inc=f[1] - f[0] if is_even else 0.0,
            abscissa_spec_data_type=18,
            abscissa_axis_units_lab="Hz",
            ord_data_type=6 if precision == "double" else 5,
            ordinate_spec_data_type=kind,
            ordinate_axis_units_lab=unit,
            orddenom_spec_data_type=9,
            orddenom_axis_units_lab="N",
        )
        data["n_bytes"] = 0
        pyuff.UFF(f"{directory}/{name}.unv").write_sets(data, mode="overwrite", force_double=precision == "double")


def read(path):
    for data in pyuff.UFF(path).read_sets():
        if data["type"] == 58:
            for f, value in zip(data["x"], data["data"]):
                print(f"{data['rsp_node']},{data['rsp_dir']},{data['ref_node']},{data['ref_dir']},{float(f)!r},{float(value.real)!r},{float(value.imag)!r}")


if __name__ == "__main__":
    {"write": write, "read": read}[sys.argv[1]](sys.argv[2])
