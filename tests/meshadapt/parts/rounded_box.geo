// A box from the origin to (1, 0.8, 0.6) whose edges are rounded by radius 0.2.
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 0.8, 0.6};
Fillet{1}{1:12}{0.2}
