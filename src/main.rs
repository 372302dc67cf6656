//! Command line of bolted-joint.
fn main() {
    println!("{}", env!("CARGO_PKG_VERSION"));
}
