//! The `cosfly` command.
fn main() {}
