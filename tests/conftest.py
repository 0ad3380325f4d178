"""Settings that all tests share."""

from hypothesis import settings

# The clock decides nothing here, and the same examples are tried at every run: a red test can be repeated.
settings.register_profile("repeatable", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("repeatable")
