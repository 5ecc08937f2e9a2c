"""Full bodies: all nodes of a mesh as coordinates."""
