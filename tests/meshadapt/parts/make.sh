#!/bin/sh
# Makes the meshes of the parts beside it with Gmsh (4.8 was used) and the ductile program, whose path is
# the argument: NAME.coarse.meshb with 8 to 12 edges around a circle, NAME.fine.meshb with 16 to 30.
# References are the numbers of OpenCASCADE's faces and curves.
set -eu
cd "$(dirname "$0")"
work=$(mktemp -d)
mesh() { # part dimension fineness edges-around-a-circle largest-size
  gmsh -"$2" "$1".geo -o "$work/$1.mesh" -v 1 -nt 1 \
    -setnumber Mesh.MeshSizeFromCurvature "$4" -setnumber Mesh.MeshSizeMax "$5" -setnumber Mesh.Algorithm 6
  "$ductile" convert "$work/$1.mesh" "$1.$3.meshb"
}
ductile=$1
mesh plate 3 coarse 12 0.5
mesh plate 3 fine 30 0.3
mesh cut_sphere 3 coarse 10 0.7
mesh cut_sphere 3 fine 30 0.5
mesh rounded_box 3 coarse 8 0.3
mesh rounded_box 3 fine 16 0.3
mesh torus 3 coarse 10 0.5
mesh torus 3 fine 16 0.4
mesh blade 3 coarse 10 0.3
mesh blade 3 fine 16 0.3
mesh plate2d 2 coarse 12 0.5
mesh plate2d 2 fine 30 0.3
rm -r "$work"
