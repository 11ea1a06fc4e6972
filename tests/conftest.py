from hypothesis import settings

# Building a diagram takes as long as it takes, on a busy machine longer than Hypothesis' 0.2 s.
settings.register_profile("drake-formation", deadline=None)
settings.load_profile("drake-formation")
