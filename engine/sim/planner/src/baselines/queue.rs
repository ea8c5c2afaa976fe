//! A monotone priority queue: a radix heap over the bits of costs that never fall.
//!
//! Non-negative `f32` compare like their bits, and best-first search never puts back a smaller cost than it took
//! out, so a bucket per highest differing bit replaces a comparison heap (Ahuja, Mehlhorn, Orlin, Tarjan 1990).

/// Entries (cost, item) that come out by rising cost; equal costs last in, first out.
pub struct RadixQueue {
    /// Bucket b holds keys whose highest bit that differs from `last` is b - 1; bucket 0 those equal to it.
    buckets: [Vec<(u32, u32)>; 33],
    last: u32,
}

impl Default for RadixQueue {
    fn default() -> Self {
        Self { buckets: core::array::from_fn(|_| Vec::new()), last: 0 }
    }
}

impl RadixQueue {
    /// Adds an item. A cost below the last one taken out counts as equal to it; not a number as infinity.
    pub fn push(&mut self, cost: f32, item: u32) {
        let cost = if cost.is_nan() { f32::INFINITY } else { cost.max(0.0) };
        let key = cost.to_bits().max(self.last);
        self.buckets[bucket(key, self.last)].push((key, item));
    }

    /// Takes out the cheapest.
    pub fn pop(&mut self) -> Option<(f32, u32)> {
        if self.buckets[0].is_empty() {
            let from = self.buckets.iter().position(|entries| !entries.is_empty())?;
            let mut entries = core::mem::take(&mut self.buckets[from]);
            self.last = entries.iter().map(|entry| entry.0).min()?;
            for &entry in &entries {
                self.buckets[bucket(entry.0, self.last)].push(entry);
            }
            entries.clear();
            self.buckets[from] = entries;
        }
        self.buckets[0].pop().map(|(key, item)| (f32::from_bits(key), item))
    }
}

fn bucket(key: u32, last: u32) -> usize {
    (32 - (key ^ last).leading_zeros()) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_random::Seed;

    #[test]
    fn costs_come_out_sorted_while_larger_ones_go_in() {
        let mut stream = Seed::of_item(1, "queue", "test").stream("costs");
        let mut queue = RadixQueue::default();
        (0..100).for_each(|item| queue.push(stream.uniform(0.0, 10.0) as f32, item));
        let (mut last, mut taken) = (0.0, 0);
        while let Some((cost, item)) = queue.pop() {
            assert!(cost >= last, "{cost} after {last}");
            (last, taken) = (cost, taken + 1);
            if item < 100 {
                queue.push(cost + stream.uniform(0.0, 3.0) as f32, item + 100);
            }
        }
        assert_eq!(taken, 200);
    }
}
