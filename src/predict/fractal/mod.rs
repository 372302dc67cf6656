//! Normal and tangential stiffness and damping of two rough surfaces under a pressure (Zhao).
