"""Results in other programs' formats, one a module.

- ``frame``: a tidy pandas DataFrame.
- ``csv_file``: that as comma-separated values.
- ``mat_file``: a struct for MATLAB.
- ``mcap_file``: robots, object and obstacles, and all signals, for Foxglove; ``foxglove`` and
  ``foxglove_schemas`` have the messages it knows.
- ``rrd_file``: the same for Rerun.
- ``scene``: what both of these show in three dimensions; ``shapes`` its solids as boxes, cylinders and triangles.

In a notebook, :class:`drake_formation.results.FormationAccessor` has them all.
"""
