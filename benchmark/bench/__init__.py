"""Runs fiber_bench over whole experiments and draws what comes out; see scripts/bench.sh."""
