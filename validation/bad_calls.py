"""Thousands of bad calls: is each refused by a message that names the argument?

Run ``python bad_calls.py``, with ``--quick`` for a share of them, ``--list FILE`` to keep what was
not refused clearly. The values and the calls are in the package ``bad_calls`` beside this file.
"""

from bad_calls.report import main

if __name__ == "__main__":
    main()
