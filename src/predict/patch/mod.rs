//! Stiffness and damping of a whole interface, from those of its points.
