MeshVersionFormatted 2
Dimension 2
SolAtVertices
2
1 3
4 0.5 4
1e16 0 1
End
