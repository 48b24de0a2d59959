//! Bordered tridiagonal systems of linear equations.

/// The largest number of border columns.
pub(super) const MAX_COLUMNS: usize = 16;

/// A factored symmetric tridiagonal matrix `T`, with border columns `c` and their solutions `T⁻¹ c`.
#[derive(Debug, Default)]
pub(super) struct BorderedTridiagonal {
    size: usize,
    pivots_inverse: Vec<f64>,
    /// The subdiagonal of the unit lower factor. A zero at either end gives every row a predecessor and a successor.
    lower: Vec<f64>,
    /// The number of negative eigenvalues of `T`.
    pub(super) negative: usize,
    columns: Vec<f64>,
    solved: Vec<f64>,
    pub(super) count: usize,
    /// The products `cᵀ T⁻¹ d` of all pairs of columns.
    pub(super) products: [[f64; MAX_COLUMNS]; MAX_COLUMNS],
}

/// The smallest admissible pivot, relative to the diagonal entry of its row.
const MIN_PIVOT: f64 = 1e-9;
/// The smallest admissible pivot of the dense system, relative to the original diagonal entry. Anything smaller is
/// rounding error.
const MIN_SHARE: f64 = 1e-12;

impl BorderedTridiagonal {
    /// Factors the matrix with this diagonal and off-diagonal by `L D Lᵀ` without pivoting. Returns `None` if a pivot
    /// is too small.
    pub(super) fn factor(&mut self, diagonal: &[f64], off_diagonal: &[f64]) -> Option<()> {
        self.size = diagonal.len();
        self.count = 0;
        self.negative = 0;
        self.pivots_inverse.clear();
        self.lower.clear();
        self.lower.push(0.0);
        let mut fill_in = 0.0;
        for (&entry, &off_diagonal) in diagonal.iter().zip(off_diagonal.iter().chain(&[0.0])) {
            let pivot = entry - fill_in;
            if pivot.is_nan() || pivot.abs() <= MIN_PIVOT * entry.abs() {
                return None;
            }
            self.negative += usize::from(pivot < 0.0);
            let inverse = pivot.recip();
            let lower = off_diagonal * inverse;
            fill_in = lower * off_diagonal;
            self.pivots_inverse.push(inverse);
            self.lower.push(lower);
        }
        Some(())
    }

    /// Adds the column that `fill` writes completely. Returns its index, or `None` if all columns are in use.
    pub(super) fn add(&mut self, fill: impl FnOnce(&mut [f64])) -> Option<usize> {
        let (index, size) = (self.count, self.size);
        if index >= MAX_COLUMNS {
            return None;
        }
        let (from, to) = (index * size, (index + 1) * size);
        if self.columns.len() < to {
            self.columns.resize(to, 0.0);
            self.solved.resize(to, 0.0);
        }
        let (column, solved) = (&mut self.columns[from..to], &mut self.solved[from..to]);
        fill(column);
        let mut previous = 0.0;
        for ((solved, &entry), &lower) in solved.iter_mut().zip(&*column).zip(&self.lower) {
            previous = entry - lower * previous;
            *solved = previous;
        }
        let mut next = 0.0;
        for ((solved, &inverse), &lower) in solved.iter_mut().zip(&self.pivots_inverse).zip(&self.lower[1..]).rev() {
            next = *solved * inverse - lower * next;
            *solved = next;
        }
        self.count += 1;
        let column = &self.columns[from..to];
        for (other, solved) in self.solved.chunks_exact(size).take(index + 1).enumerate() {
            let product = column.iter().zip(solved).map(|(a, b)| a * b).sum();
            self.products[index][other] = product;
            self.products[other][index] = product;
        }
        Some(index)
    }

    /// Returns the solution `T⁻¹ c` of a column.
    pub(super) fn solved(&self, column: usize) -> &[f64] {
        &self.solved[column * self.size..(column + 1) * self.size]
    }
}

/// A small dense symmetric system. Only its first `size` rows and columns are in use.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SmallSystem {
    pub(super) size: usize,
    pub(super) matrix: [[f64; MAX_COLUMNS]; MAX_COLUMNS],
    pub(super) rhs: [f64; MAX_COLUMNS],
}

impl SmallSystem {
    /// Returns the solution and the number of positive eigenvalues of the matrix, or `None` if it is singular. The
    /// matrix is overwritten.
    ///
    /// The factorisation is `L D Lᵀ` with diagonal pivoting. Every pivot is compared with the original diagonal entry
    /// of its row.
    pub(super) fn solve(&mut self) -> Option<([f64; MAX_COLUMNS], usize)> {
        let size = self.size;
        let mut scale = [0.0; MAX_COLUMNS];
        for (row, scale) in scale.iter_mut().enumerate().take(size) {
            *scale = self.matrix[row][row].abs();
            if *scale == 0.0 {
                return None;
            }
        }
        let mut order: [usize; MAX_COLUMNS] = std::array::from_fn(|index| index);
        let mut positive = 0;
        for step in 0..size {
            let weight = |&row: &usize| (self.matrix[row][row] / scale[row]).abs();
            let best = (step..size).max_by(|&a, &b| weight(&order[a]).total_cmp(&weight(&order[b])))?;
            order.swap(step, best);
            let row = order[step];
            let pivot = self.matrix[row][row];
            if pivot.is_nan() || pivot.abs() <= MIN_SHARE * scale[row] {
                return None;
            }
            positive += usize::from(pivot > 0.0);
            for &below in &order[step + 1..size] {
                let factor = self.matrix[below][row] / pivot;
                for &column in &order[step + 1..size] {
                    self.matrix[below][column] -= factor * self.matrix[row][column];
                }
                self.rhs[below] -= factor * self.rhs[row];
            }
        }
        let mut solution = [0.0; MAX_COLUMNS];
        for step in (0..size).rev() {
            let row = order[step];
            let rest: f64 =
                order[step + 1..size].iter().map(|&column| self.matrix[row][column] * solution[column]).sum();
            solution[row] = (self.rhs[row] - rest) / self.matrix[row][row];
        }
        Some((solution, positive))
    }
}
