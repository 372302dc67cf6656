//! The study of a prediction: what its file says, validated.
