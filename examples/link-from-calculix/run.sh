#!/bin/sh
# From a meshed link to a robot: gmsh meshes, CalculiX solves, kinetostat takes the stiffness over.
#
#   run.sh [FOLDER]          files go to FOLDER (link-from-calculix without it)
#   KINETOSTAT=path run.sh   another binary than the `kinetostat` of the PATH
#
# Needs gmsh and ccx (Debian: apt-get install gmsh calculix-ccx); says SKIPPED without them.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
kinetostat=${KINETOSTAT:-kinetostat}
for program in gmsh ccx awk; do
    if ! command -v "$program" > /dev/null 2>&1; then
        echo "SKIPPED: $program is not installed (Debian: apt-get install gmsh calculix-ccx)"
        exit 0
    fi
done
folder=${1:-link-from-calculix}
mkdir -p "$folder"
cd "$folder"
cp "$here"/link.geo "$here"/matrix.inp "$here"/loads.inp .

# 1. A mesh. gmsh writes the faces as elements too; only their nodes are wanted.
gmsh -3 link.geo -format inp -o gmsh.inp > gmsh.log
awk '/^\*/ { skip = /type=CPS/ || /^\*ELSET,ELSET=(ROOT|TIP)/ } !skip' gmsh.inp > link-mesh.inp

# 2. CalculiX: the stiffness matrix of the mesh, and the displacements under six loads.
ccx matrix > matrix.log
ccx loads > loads.log

# 3. Two ways to the same 6 x 6: the stored matrix, and the displacements.
"$kinetostat" import matrix matrix.sti --dofs matrix.dof --nodes link-mesh.inp --units n-mm \
    --interface TIP --fixed ROOT --end-mm 600 0 0 --name boom --out boom.toml --force-overwrite
"$kinetostat" import link-displacements loads.dat --nodes link-mesh.inp --units n-mm \
    --end-mm 600 0 0 --force-n 1000 --moment-n-mm 1e5 --name boom --out boom-by-loads.toml --force-overwrite

# 4. The robot.
cat "$here"/robot-without-link.toml boom.toml > robot.toml
"$kinetostat" check robot.toml
"$kinetostat" stiffness robot.toml
