"""Static centrifugal stress of a solid rotor and the stiffness that it gives."""
