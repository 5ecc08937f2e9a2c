"""Bad calls made from signatures, and how each of them was answered."""
