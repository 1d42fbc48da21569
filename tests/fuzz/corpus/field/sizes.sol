MeshVersionFormatted 2
Dimension 2
SolAtVertices
3
1 1
0.1 0.2 3e-1
End
