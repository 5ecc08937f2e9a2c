"""Whether the tests notice wrong physics: signs, factors, dropped terms, swapped indices, frames.

Run ``python validation/mutations.py``; ``--quick`` does ten, ``--list`` shows all, ``--only TEXT``
those with the text in their line.
"""

import sys

from mutations.run import main

if __name__ == "__main__":
    sys.exit(main())
