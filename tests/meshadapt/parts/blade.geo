// A blade of chord 1 and height 1.5 along z: a profile 0.12 thick with a round nose and a blunt tail,
// twisted by 40 degrees and tapered to 0.6.
SetFactory("OpenCASCADE");
n = 12;
For k In {0:3}
  z = 0.5 * k; turn = 40 * Pi / 180 * k / 3; scale = 1 - 0.4 * k / 3;
  first = newp;
  For i In {0:2*n}
    u = (i - n) / n;
    x = u * u;
    half = 0.6 * (0.2969 * Abs(u) - 0.126 * x - 0.3516 * x^2 + 0.2843 * x^3 - 0.1015 * x^4);
    y = (u < 0 ? -half : half) + 0.15 * x * (1 - x);
    Point(newp) = {scale * ((x - 0.4) * Cos(turn) - y * Sin(turn)),
                   scale * ((x - 0.4) * Sin(turn) + y * Cos(turn)), z};
  EndFor
  Spline(10 * k + 1) = {first:first + 2 * n};
  Line(10 * k + 2) = {first + 2 * n, first};
  Wire(k + 1) = {10 * k + 1, 10 * k + 2};
EndFor
ThruSections(1) = {1, 2, 3, 4};
Recursive Delete { Curve{1, 2, 11, 12, 21, 22, 31, 32}; }
