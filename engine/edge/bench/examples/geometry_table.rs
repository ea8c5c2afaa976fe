//! Prints the table of box queries: `cargo run --release -p cosfly-bench --example geometry_table [SEED]`.

fn main() {
    let seed = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(1);
    println!("{}", cosfly_bench::geometry::geometry(seed));
}
