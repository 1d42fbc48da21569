// In the plane: a square of side 2 with a hole of radius 0.4, and an ellipse of half axes 0.3 and 0.15 that
// is a region of its own.
SetFactory("OpenCASCADE");
Rectangle(1) = {-1, -1, 0, 2, 2};
Disk(2) = {-0.2, 0, 0, 0.4};
Disk(3) = {0.6, 0.3, 0, 0.3, 0.15};
BooleanDifference(4) = { Surface{1}; Delete; }{ Surface{2}; Delete; };
BooleanFragments{ Surface{4}; Delete; }{ Surface{3}; Delete; }
