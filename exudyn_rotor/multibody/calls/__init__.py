"""What is put around calls of Exudyn's mbs."""
