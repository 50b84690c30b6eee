"""Set up before numba is imported: two threads, however few cores, so that tests of determinism can fail."""

import os

os.environ.setdefault("NUMBA_NUM_THREADS", "2")
