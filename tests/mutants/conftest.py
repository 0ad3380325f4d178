"""The tool's own modules hold no tests, and need forks and coverage: only `make mutants` imports them."""

collect_ignore_glob = ["[!t]*.py"]
