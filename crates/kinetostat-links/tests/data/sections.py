"""Golden values of sections and tapered links, independent of kinetostat: mpmath quadrature, 30 digits."""
import json
from mpmath import mp, mpf, quad, pi, tanh, nsum, inf

mp.dps = 30


def torsion(a, b):
    a, b = max(a, b), min(a, b)
    s = nsum(lambda k: tanh((2 * k + 1) * pi * a / (2 * b)) / (2 * k + 1) ** 5, [0, inf])
    return a * b**3 / 3 * (1 - 192 / pi**5 * b / a * s)


# tapered rectangle 60 x 100 -> 30 x 40 mm, 0.5 m, E 70 GPa, nu 0.3, with shear 5/6 (nu = 0: Cowper 10/12)
L, E, nu = mpf("0.5"), mpf(70) * 10**9, mpf(0)
G = E / (2 + 2 * nu)
w = lambda x: mpf("0.06") + (mpf("0.03") - mpf("0.06")) * x / L
h = lambda x: mpf("0.10") + (mpf("0.04") - mpf("0.10")) * x / L
I = lambda f: quad(f, [0, L / 4, L / 2, 3 * L / 4, L])
A = lambda x: w(x) * h(x)
Iy = lambda x: w(x) * h(x) ** 3 / 12
Iz = lambda x: h(x) * w(x) ** 3 / 12
kap = mpf(10) / 12
C = {"xx": I(lambda x: 1 / (E * A(x))), "rxrx": I(lambda x: 1 / (G * torsion(w(x), h(x)))),
     "yy": I(lambda x: (L - x) ** 2 / (E * Iz(x)) + 1 / (G * kap * A(x))), "yrz": I(lambda x: (L - x) / (E * Iz(x))),
     "rzrz": I(lambda x: 1 / (E * Iz(x))), "zz": I(lambda x: (L - x) ** 2 / (E * Iy(x)) + 1 / (G * kap * A(x))),
     "zry": I(lambda x: -(L - x) / (E * Iy(x))), "ryry": I(lambda x: 1 / (E * Iy(x)))}


def energy_kappa(parts, total, second):
    """Shear coefficient from the energy of the shear flow (nu = 0): I^2 / (A int Q^2/t ds)."""
    return second**2 / (total * sum(parts))


# thin I: centre-line b 80, h 114, flange 6, web 8; thin box: b 76, h 114, walls 4 (sides) and 6 (top), mm
def thin_i(b, h, tf, tw):
    A = 2 * b * tf + h * tw
    I2 = tw * h**3 / 12 + 2 * b * tf * h**2 / 4
    web = quad(lambda z: (b * tf * h / 2 + tw / 2 * (h**2 / 4 - z**2)) ** 2 / tw, [-h / 2, h / 2])
    fl = 4 * quad(lambda s: (tf * s * h / 2) ** 2 / tf, [0, b / 2])
    return energy_kappa([web, fl], A, I2)


def thin_box(b, h, tf, tw):
    A = 2 * b * tf + 2 * h * tw
    I2 = 2 * tw * h**3 / 12 + 2 * b * tf * h**2 / 4
    web = 2 * quad(lambda z: (b * tf * h / 4 + tw / 2 * (h**2 / 4 - z**2)) ** 2 / tw, [-h / 2, h / 2])
    fl = 4 * quad(lambda s: (tf * s * h / 2) ** 2 / tf, [0, b / 2])
    return energy_kappa([web, fl], A, I2)


out = {"tapered_rectangle_compliance_si": {k: float(v) for k, v in C.items()},
       "torsion_100_x_30_mm4": float(torsion(mpf(100), mpf(30))),
       "thin_i_kappa_nu_0": float(thin_i(mpf(80), mpf(114), mpf(6), mpf(8))),
       "thin_box_kappa_nu_0": float(thin_box(mpf(76), mpf(114), mpf(6), mpf(4)))}
json.dump(out, open("sections.json", "w"), indent=1)
print(json.dumps(out, indent=1))
