// A torus around the z axis of radii 1 and 0.35.
SetFactory("OpenCASCADE");
Torus(1) = {0, 0, 0, 1, 0.35};
