"""Cases, the one comparer, the report and the regression gate: `python -m verification.run --help`."""
