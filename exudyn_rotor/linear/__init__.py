"""Linear analyses of a rotor on supports, or of a scene with a rotor in it.

Folders import one way: ``periodic`` (linear equations with periodic coefficients and how they are
solved; knows nothing of rotors) < ``models`` (what is analysed) < ``modal``, ``response``,
``stability`` (the analyses).
"""
