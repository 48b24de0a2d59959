//! Set-up, demonstration and checks of Vibrissa, one command each.

fn main() {}
