//! The newest results of slow computations.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

/// Number of kept results.
const MOST_KEPT: usize = 32;

/// The newest results of a slow computation by their inputs, so that most runs of a process share them.
pub(super) struct Newest<K, V>(Mutex<VecDeque<(K, Arc<V>)>>);

impl<K: PartialEq, V> Newest<K, V> {
    /// No results.
    pub(super) const fn new() -> Self {
        Self(Mutex::new(VecDeque::new()))
    }

    /// The result for `key`, which is computed if it is not kept. Errors are not kept.
    ///
    /// # Errors
    /// That of the computation.
    pub(super) fn get_or<E>(&self, key: K, compute: impl FnOnce() -> Result<V, E>) -> Result<Arc<V>, E> {
        // A result is complete before it is kept, so a panic cannot leave an incomplete one.
        let kept = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, value)) = kept().iter().find(|(other, _)| *other == key) {
            return Ok(Arc::clone(value));
        }
        let value = Arc::new(compute()?);
        let mut kept = kept();
        kept.truncate(MOST_KEPT - 1);
        kept.push_front((key, Arc::clone(&value)));
        Ok(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_result_is_computed_once_until_many_others_follow() {
        let newest = Newest::new();
        let mut computed = Vec::new();
        let mut get = |key: usize| {
            let value = newest.get_or(key, || {
                computed.push(key);
                if key == 99 { Err("none") } else { Ok(key * key) }
            });
            value.map(|value| *value)
        };
        assert_eq!([get(3), get(3), get(99), get(99)], [Ok(9), Ok(9), Err("none"), Err("none")]);
        for other in 100..100 + MOST_KEPT {
            assert_eq!(get(other), Ok(other * other));
        }
        assert_eq!(get(3), Ok(9));
        assert_eq!(computed.iter().filter(|&&key| key == 3).count(), 2);
        assert_eq!(computed.iter().filter(|&&key| key == 99).count(), 2);
    }
}
