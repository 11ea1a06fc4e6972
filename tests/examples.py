"""Which examples Hypothesis draws: the same each time, or new ones where HYPOTHESIS_PROFILE=explore."""

import os

from hypothesis import HealthCheck, settings
from hypothesis.internal.conjecture import providers

# How long an example takes, or takes to draw, says how busy the machine is.
settings.register_profile("timeless", deadline=None, database=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("repeatable", settings.get_profile("timeless"), derandomize=True)
settings.register_profile("explore", settings.get_profile("timeless"), derandomize=False, print_blob=True)


def load_profile() -> None:
    """Load the profile that the environment names, by default the one of examples that are the same each time."""
    profile = os.environ.get("HYPOTHESIS_PROFILE", "repeatable")
    settings.load_profile(profile)
    if profile == "repeatable" and hasattr(providers, "_get_local_constants"):
        # Hypothesis also tries numbers found in the modules imported so far; those depend on the tests run before.
        providers._get_local_constants = providers.Constants
