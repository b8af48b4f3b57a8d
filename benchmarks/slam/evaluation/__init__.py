"""Logs of made-up drives, real ones made harder, and measures of their maps, for the benchmarks and for tests of `uvf.slam`."""
