"""Mutation of the solver: break it in one place at a time, and see whether a test turns red.

`make mutants` runs it (`python -m mutants` with `tests` on the path; folders or files as arguments, `--report` to see
only what is known so far). The existing tools do not fit: mutmut 3 changes nothing outside functions, where the limits
are; cosmic-ray writes into the working tree, runs one command for all mutants, and counts time by the clock.

- `sites`: what can be broken. Limits, thresholds and comparisons of order: all of them. The rest (Boolean words, kinds
  asked for by `==`, `abs`, arithmetic, other numbers, results, statements left out): the 400 whose keys come first, a
  sample that hardly changes when the code does.
- `choice`: which tests. Each test file runs once under coverage; a mutant is shown the tests that run its lines, those
  of its own file first, then its room's, quick ones before slow ones, then the other tests of the same files (which may
  share a cached result), until a bound on processor time.
- `in_memory`: the quick way, for all of them. A process that holds the collected tests forks for each mutant and gives
  functions and values of the broken file to what is loaded; a test that turns red counts if it is green without that.
- `running`: a process of its own, in which everything is imported anew, for whom the quick way leaves alive without a
  reason or cannot break (what other modules or tests made of it when they were imported). Both work in a copy of the
  tree under `build/mutants`; the working tree is never touched. Who takes much more processor time than the tests
  usually do is ended and counts as killed; the clock decides nothing.
- `records`: what is known, one line a mutant in `build/mutants/results.jsonl`. A verdict holds until the broken
  function or the test that killed it changes; a survivor is shown the tests alone that are new or have changed. So a
  run goes on where the last one ended. `accepted.toml` has the survivors that are right to survive, each with its
  reason; they are shown less, and by the quick way alone.

Exit status: 0 all killed or explained, 1 a survivor that nobody explained, or an explanation that is stale,
3 undecided ones are left.
"""
