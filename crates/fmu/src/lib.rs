//! The shared library inside every FMU: FMI C ABIs over `bolted-joint-dynamics`.
