import os

# Many small matrices: threads of the linear algebra would wait for one another most of the time.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from hypothesis import settings

# Building a diagram takes as long as it takes, on a busy machine longer than Hypothesis' 0.2 s.
settings.register_profile("drake-formation", deadline=None)
settings.load_profile("drake-formation")
