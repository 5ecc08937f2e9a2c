"""One rotor on supports, with or without a foundation."""
