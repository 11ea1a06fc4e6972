"""Figures of runs that are not made: the same for all."""

from drake_formation.measuring import Metrics


class SameFigures:
    """Stands in for the paper's store: runs nothing, and every run has the same figures."""

    def measured(self, scenario):
        return Metrics(
            tracking_error_m=[1.0] * (2 if scenario.name == "line" else 1),
            stacked_tracking_error_m=1.0,
            consensus_error_m=1.0,
            residual_m=1.0,
            disagreement_m=0.5,
            turned_m=1.0,
            peak_force_n=1.0,
        )
