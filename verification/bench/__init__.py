"""Speed against error, as data and figures: `make bench`, `make bench-peers`; plan.toml says what is run."""
