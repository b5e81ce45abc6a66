//! The plant: against closed forms, against itself by other methods, stiff and extreme.

mod closed_forms;
mod contact_law;
mod contact_law_extremes;
mod cost_of_parts;
mod elliptic_bearing;
mod extremes;
mod flight_between_samples;
mod forward_rub;
mod machine;
mod properties;
mod retainer_race;
mod standstill;
mod starts_on_the_wall;
mod stiff_and_extreme;
mod stiff_benchmark_work;
