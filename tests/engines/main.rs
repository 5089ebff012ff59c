//! The engines in whole runs: they agree to the cycle under every kind of configuration, in any
//! number of threads, and what they say follows from its causes: the link, the intervals, the port.
//!
//! That they agree on pipelines made up at random is tested beside them, in `rtl_model`; here it is
//! the units' own blocks, and what the host sends them.

mod agree;
mod causes;
mod laws;
mod port;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "../support/random.rs"]
mod random;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "../support/run.rs"]
mod run;
mod runs;
