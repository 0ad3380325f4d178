"""Checks that several chapters need."""
