//! Linear equations with a tridiagonal matrix and a few columns beside it.

/// The most columns.
pub(super) const MOST: usize = 16;

/// A symmetric tridiagonal matrix `T`, factored, and columns `c` with their `T⁻¹ c`.
#[derive(Debug, Default)]
pub(super) struct Bordered {
    size: usize,
    pivots_inverse: Vec<f64>,
    /// What is beside the diagonal of the lower factor, between two zeros, so that every row has one before and one behind it.
    lower: Vec<f64>,
    /// How many eigenvalues of `T` are negative.
    pub(super) negative: usize,
    columns: Vec<f64>,
    solved: Vec<f64>,
    pub(super) count: usize,
    /// Products `cᵀ T⁻¹ d` of any two columns.
    pub(super) products: [[f64; MOST]; MOST],
}

/// A pivot this small beside its row is no pivot.
const LEAST_PIVOT: f64 = 1e-9;
/// As little of an entry of the diagonal as this is what rounding leaves of it.
const LEAST_SHARE: f64 = 1e-12;

impl Bordered {
    /// Factors a matrix by its diagonal and what is beside it, `None` if that cannot be done in the order of its rows.
    pub(super) fn factor(&mut self, diagonal: &[f64], beside: &[f64]) -> Option<()> {
        self.size = diagonal.len();
        self.count = 0;
        self.negative = 0;
        self.pivots_inverse.clear();
        self.lower.clear();
        self.lower.push(0.0);
        let mut fill_in = 0.0;
        for (&entry, &beside) in diagonal.iter().zip(beside.iter().chain(&[0.0])) {
            let pivot = entry - fill_in;
            if pivot.is_nan() || pivot.abs() <= LEAST_PIVOT * entry.abs() {
                return None;
            }
            self.negative += usize::from(pivot < 0.0);
            let inverse = pivot.recip();
            let lower = beside * inverse;
            fill_in = lower * beside;
            self.pivots_inverse.push(inverse);
            self.lower.push(lower);
        }
        Some(())
    }

    /// Adds a column, which `fill` gives all of; its index, `None` if there is no room.
    pub(super) fn add(&mut self, fill: impl FnOnce(&mut [f64])) -> Option<usize> {
        let (index, size) = (self.count, self.size);
        if index >= MOST {
            return None;
        }
        let (from, to) = (index * size, (index + 1) * size);
        if self.columns.len() < to {
            self.columns.resize(to, 0.0);
            self.solved.resize(to, 0.0);
        }
        let (column, solved) = (&mut self.columns[from..to], &mut self.solved[from..to]);
        fill(column);
        let mut before = 0.0;
        for ((solved, &entry), &lower) in solved.iter_mut().zip(&*column).zip(&self.lower) {
            before = entry - lower * before;
            *solved = before;
        }
        let mut after = 0.0;
        for ((solved, &inverse), &lower) in solved.iter_mut().zip(&self.pivots_inverse).zip(&self.lower[1..]).rev() {
            after = *solved * inverse - lower * after;
            *solved = after;
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

    /// `T⁻¹ c` of a column.
    pub(super) fn solved(&self, column: usize) -> &[f64] {
        &self.solved[column * self.size..(column + 1) * self.size]
    }
}

/// A small symmetric system of equations: of its rows and columns the first `size`.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Small {
    pub(super) size: usize,
    pub(super) matrix: [[f64; MOST]; MOST],
    pub(super) right: [f64; MOST],
}

impl Small {
    /// The solution, and how many eigenvalues of the matrix are positive; `None` if it is singular. The matrix is lost.
    ///
    /// By `L D Lᵀ` with the greatest entry of the diagonal as the next pivot, each beside the diagonal that was there.
    pub(super) fn solve(&mut self) -> Option<([f64; MOST], usize)> {
        let size = self.size;
        let mut scale = [0.0; MOST];
        for (row, scale) in scale.iter_mut().enumerate().take(size) {
            *scale = self.matrix[row][row].abs();
            if *scale == 0.0 {
                return None;
            }
        }
        let mut order: [usize; MOST] = std::array::from_fn(|index| index);
        let mut positive = 0;
        for step in 0..size {
            let weight = |&row: &usize| (self.matrix[row][row] / scale[row]).abs();
            let best = (step..size).max_by(|&a, &b| weight(&order[a]).total_cmp(&weight(&order[b])))?;
            order.swap(step, best);
            let row = order[step];
            let pivot = self.matrix[row][row];
            if pivot.is_nan() || pivot.abs() <= LEAST_SHARE * scale[row] {
                return None;
            }
            positive += usize::from(pivot > 0.0);
            for &below in &order[step + 1..size] {
                let factor = self.matrix[below][row] / pivot;
                for &column in &order[step + 1..size] {
                    self.matrix[below][column] -= factor * self.matrix[row][column];
                }
                self.right[below] -= factor * self.right[row];
            }
        }
        let mut solution = [0.0; MOST];
        for step in (0..size).rev() {
            let row = order[step];
            let rest: f64 =
                order[step + 1..size].iter().map(|&column| self.matrix[row][column] * solution[column]).sum();
            solution[row] = (self.right[row] - rest) / self.matrix[row][row];
        }
        Some((solution, positive))
    }
}
