MeshVersionFormatted 2
Dimension 3
SolAtVertices
2
4 1 2 3 4
1 1 2 3 1 0 1 0 0 1 1 2 3 4 5 6 7 8 9
1 1 2 3 1 0 1 0 0 1 1 2 3 4 5 6 7 8 9
End
