"""Modes of loaded machines of springs and rigid bodies by Exudyn, for comparison with kinetostat-dynamics.

Reads one JSON object from the standard input:
  ground, anchor   lists of points, m: ends of the legs on the ground (base) and on the platform (its axes)
  home             place of the platform's reference point, m
  stiffness        N/m of every leg; rest: its length without force, m, one for each leg
  mass, centre, inertia  kg, m, 3x3 kg m^2 about the centre of mass, platform axes
  gravity, force   m/s^2; N on the reference point, dead

The platform has three rotation angles, the legs are spring-dampers, so that the closed loops need no constraint
and the tangent of the springs with their preload comes from differences of their forces. That of loads (a weight off
the reference point) seems not to be in it: ask without gravity.
Writes {"squared": [w^2 ...], "position": [...]}. Exit code 3: Exudyn is not installed.
"""

import json
import os
import sys

try:
    kept = os.dup(1)
    os.dup2(2, 1)  # Exudyn talks
    import exudyn as exu
    import numpy as np
    from exudyn.rigidBodyUtilities import RigidBodyInertia
except ImportError:
    sys.exit(3)


def main():
    asked = json.load(sys.stdin)
    system = exu.SystemContainer()
    mbs = system.AddSystem()
    centre = np.array(asked["centre"])
    mass = asked["mass"]
    about = np.array(asked["inertia"]) + mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    body = mbs.CreateRigidBody(
        inertia=RigidBodyInertia(mass=mass, inertiaTensor=about, com=centre, inertiaTensorAtCOM=False),
        nodeType=exu.NodeType.RotationRxyz,
        referencePosition=asked["home"],
        gravity=asked["gravity"],
    )
    ground = mbs.CreateGround()
    for a, b, rest in zip(asked["ground"], asked["anchor"], asked["rest"]):
        mbs.CreateSpringDamper(
            bodyNumbers=[ground, body], localPosition0=a, localPosition1=b,
            stiffness=asked["stiffness"], damping=0, referenceLength=rest,
        )
    mbs.CreateForce(bodyNumber=body, loadVector=asked["force"], localPosition=[0, 0, 0])
    mbs.Assemble()
    settings = exu.SimulationSettings()
    for solver in (settings.staticSolver, settings.timeIntegration):
        newton = solver.newton
        newton.numericalDifferentiation.forODE2 = True
        newton.numericalDifferentiation.relativeEpsilon = 1e-7
    settings.staticSolver.numberOfLoadSteps = 10
    settings.staticSolver.newton.relativeTolerance = 1e-11
    settings.staticSolver.newton.absoluteTolerance = 1e-6  # N
    settings.staticSolver.verboseMode = 0
    settings.solutionSettings.writeSolutionToFile = False
    mbs.SolveStatic(settings, updateInitialValues=True)
    values, _ = mbs.ComputeODE2Eigenvalues(settings, useAbsoluteValues=False)
    found = {
        "squared": [float(np.real(v)) for v in values],
        "position": list(map(float, mbs.GetObjectOutputBody(body, exu.OutputVariableType.Position, [0, 0, 0]))),
    }
    os.write(kept, json.dumps(found).encode())


main()
