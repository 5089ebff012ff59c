// Whose an item is. Stands before the texts of kernels that have an invocation an item and a
// buffer `starts`, in which each patch's items begin.

// The last patch, of `first` to before `end`, whose items begin at this one or before: by
// bisection.
fn owner(item: u32, first: u32, end: u32) -> u32 {
    var low = first;
    var high = end;
    while (high - low > 1u) {
        let middle = (low + high) / 2u;
        let before = starts[middle] <= item;
        low = select(low, middle, before);
        high = select(middle, high, before);
    }
    return low;
}
