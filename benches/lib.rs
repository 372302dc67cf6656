//! Nothing but the benchmarks beside it: a package has to have something that is no benchmark.
