//! Frequency response functions: what was measured, between which degrees of freedom, in which units.
