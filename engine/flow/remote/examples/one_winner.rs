//! `one_winner PLACE`: sixteen writers create one object a thousand times in all; prints the number of those who were told that
//! they wrote it. For `tests/outside/check_s3.py`.

use cosfly_remote::Bucket;
use cosfly_store::Remote;
use std::sync::atomic::{AtomicU32, Ordering};

fn main() {
    let place = std::env::args().nth(1).expect("a place");
    let bucket = Bucket::open(&place).expect("a bucket");
    let winners = AtomicU32::new(0);
    std::thread::scope(|scope| {
        for writer in 0..16_u32 {
            let (bucket, winners) = (&bucket, &winners);
            scope.spawn(move || {
                for attempt in (writer..1000).step_by(16) {
                    let created = bucket.create("race", format!("{writer} {attempt}").into_bytes()).expect("an answer");
                    winners.fetch_add(u32::from(created), Ordering::Relaxed);
                }
            });
        }
    });
    println!("{}", winners.into_inner());
}
