//! Values that are not known well: a value and its standard deviation, and what follows from them by Monte Carlo.
