// A plate of 2 by 2 by 0.2 with a hole of radius 0.4 around the z axis.
SetFactory("OpenCASCADE");
Box(1) = {-1, -1, 0, 2, 2, 0.2};
Cylinder(2) = {0, 0, -1, 0, 0, 3, 0.4};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
