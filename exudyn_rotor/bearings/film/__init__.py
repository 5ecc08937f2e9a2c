"""Oil films of journal bearings by Reynolds' equation."""
