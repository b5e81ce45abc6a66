//! Matrices and texts as a MAT file of version 5, uncompressed.

use firmware_bench::scene::linear_loop::DesignPlant;

/// Types of data and classes of arrays of the format.
const INT8: u32 = 1;
const UINT16: u32 = 4;
const INT32: u32 = 5;
const UINT32: u32 = 6;
const DOUBLE: u32 = 9;
const MATRIX: u32 = 14;
const CELL_CLASS: u32 = 1;
const CHAR_CLASS: u32 = 4;
const DOUBLE_CLASS: u32 = 6;

/// The plant's matrices, spin, period, and names of inputs, outputs and states as cells of text.
pub(super) fn write(plant: &DesignPlant) -> Vec<u8> {
    let mut file = vec![b' '; 116];
    let what = b"MATLAB 5.0 MAT-file";
    file[..what.len()].copy_from_slice(what);
    file.extend([0; 8]);
    file.extend(0x0100_u16.to_le_bytes());
    file.extend(*b"IM");
    for (name, matrix) in plant.arrays() {
        file.extend(numbers(name, matrix.shape(), matrix.as_slice()));
    }
    let names = &plant.names;
    for (name, value) in [
        ("spin_rad_s", names.spin_rad_s),
        ("sample_period_s", names.sample_period_s),
    ] {
        file.extend(numbers(name, (1, 1), &[value]));
    }
    file.extend(cells("inputs_n", &names.inputs_n));
    file.extend(cells("outputs_m", &names.outputs_m));
    file.extend(cells("states", &names.states));
    file.extend(cells("state_units", &names.state_units));
    file
}

/// A tag and what it is of, filled up to eight bytes.
fn element(kind: u32, bytes: &[u8]) -> Vec<u8> {
    let mut all = [kind, bytes.len() as u32].map(u32::to_le_bytes).concat();
    all.extend(bytes);
    all.resize(all.len().next_multiple_of(8), 0);
    all
}

fn array(name: &str, class: u32, shape: (usize, usize), content: &[u8]) -> Vec<u8> {
    let flags = [class, 0].map(u32::to_le_bytes).concat();
    let shape = [shape.0 as i32, shape.1 as i32].map(i32::to_le_bytes);
    let head = [
        element(UINT32, &flags),
        element(INT32, &shape.concat()),
        element(INT8, name.as_bytes()),
    ];
    element(MATRIX, &[&head.concat(), content].concat())
}

/// Column by column.
fn numbers(name: &str, shape: (usize, usize), all: &[f64]) -> Vec<u8> {
    let bytes: Vec<u8> = all.iter().flat_map(|x| x.to_le_bytes()).collect();
    array(name, DOUBLE_CLASS, shape, &element(DOUBLE, &bytes))
}

fn cells<T: AsRef<str>>(name: &str, texts: &[T]) -> Vec<u8> {
    let cell = |text: &T| {
        let units: Vec<u16> = text.as_ref().encode_utf16().collect();
        let bytes: Vec<u8> = units.iter().flat_map(|x| x.to_le_bytes()).collect();
        array("", CHAR_CLASS, (1, units.len()), &element(UINT16, &bytes))
    };
    let all: Vec<u8> = texts.iter().flat_map(cell).collect();
    array(name, CELL_CLASS, (texts.len(), 1), &all)
}
