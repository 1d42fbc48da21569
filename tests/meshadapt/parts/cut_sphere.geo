// A ball of radius 1 around the origin without what is above z = 0.6.
SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 0, 1};
Box(2) = {-2, -2, 0.6, 4, 4, 2};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
