//! Fractal dimension and roughness of a surface, from measured profiles.
