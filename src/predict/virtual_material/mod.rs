//! An elastic layer that stands for the joint in a finite-element model (Tian).
