//! Linear equations with a tridiagonal matrix and a few columns beside it.

/// The most columns.
pub(super) const MOST: usize = 16;

/// A symmetric tridiagonal matrix `T`, factored, and columns `c` with their `T⁻¹ c`.
#[derive(Debug, Default)]
pub(super) struct Bordered {
    size: usize,
    pivots_inverse: Vec<f64>,
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
        for all in [&mut self.pivots_inverse, &mut self.lower] {
            all.clear();
        }
        let mut pivot = *diagonal.first()?;
        for row in 0..self.size {
            if pivot.is_nan() || pivot.abs() <= LEAST_PIVOT * diagonal[row].abs() {
                return None;
            }
            self.negative += usize::from(pivot < 0.0);
            let inverse = pivot.recip();
            self.pivots_inverse.push(inverse);
            if let Some(&beside) = beside.get(row) {
                let lower = beside * inverse;
                self.lower.push(lower);
                pivot = diagonal[row + 1] - lower * beside;
            }
        }
        Some(())
    }

    /// Adds a column, of which `fill` gives every row; its index, `None` if there is no room.
    pub(super) fn add(&mut self, fill: impl Fn(usize) -> f64) -> Option<usize> {
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
        let mut before = 0.0;
        for row in 0..size {
            column[row] = fill(row);
            before = if row > 0 { column[row] - self.lower[row - 1] * before } else { column[row] };
            solved[row] = before;
        }
        let mut after = 0.0;
        for row in (0..size).rev() {
            let lower = self.lower.get(row).copied().unwrap_or(0.0);
            after = solved[row] * self.pivots_inverse[row] - lower * after;
            solved[row] = after;
        }
        self.count += 1;
        for other in 0..=index {
            let product = self.columns[from..to].iter().zip(self.solved(other)).map(|(a, b)| a * b).sum();
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

/// A small symmetric system of equations.
#[derive(Debug, Clone, Copy)]
pub(super) struct Small {
    pub(super) size: usize,
    pub(super) matrix: [[f64; MOST]; MOST],
    pub(super) right: [f64; MOST],
}

impl Small {
    /// The solution, and how many eigenvalues of the matrix are positive; `None` if it is singular.
    ///
    /// By `L D Lᵀ` with the greatest entry of the diagonal as the next pivot, each beside the diagonal that was there.
    pub(super) fn solve(mut self) -> Option<([f64; MOST], usize)> {
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
