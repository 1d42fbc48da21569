MeshVersionFormatted 2
Dimension 3
SolAtVertices
2
1 3
4 0 4 0 0 4
9 1 9 1 1 9
End
