"""How far every input can be pushed, what breaks first, and what the user is told there.

Run ``python extremes.py``, with ``--quick`` for less than a minute, ``--json FILE`` to keep the
rows. The measurements are in the package ``extremes`` beside this file.
"""

from extremes.table import main

if __name__ == "__main__":
    main()
