"""Linear analyses of a rotor on supports, or of a scene with a rotor in it.

Folders import one way: ``solve`` (how linear equations are solved; knows nothing of rotors) and
``model`` (what is analysed) < ``modal``, ``response``, ``static``, ``stability`` (the analyses).
"""
