"""Meshes and matrices of other programs as files: Abaqus, CalculiX, ANSYS, Nastran, meshio."""
