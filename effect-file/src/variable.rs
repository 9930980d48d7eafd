//! What a formula can ask of every recording.

/// A variable that every formula has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Variable {
    /// `cx cy cz`: the direction of the Earth's field in body axes.
    Direction(usize),
    /// `dcx dcy dcz`: its time derivative, 1/s.
    DirectionRate(usize),
    /// `F`: magnitude of the Earth's field, nT.
    Field,
    /// `s`: the clean scalar reading, nT.
    Scalar,
    /// `fx fy fz`: the clean fluxgate reading, nT.
    Flux(usize),
    /// `t`: s since the recording's first row.
    Time,
    /// `time_s`: the recording's own axis, s.
    RecordingTime,
    /// `depth`, m.
    Depth,
    /// `temperature`, degC.
    Temperature,
}

/// Every variable by its name. `pi` is a number.
pub const VARIABLES: [(&str, Variable); 15] = [
    ("cx", Variable::Direction(0)),
    ("cy", Variable::Direction(1)),
    ("cz", Variable::Direction(2)),
    ("dcx", Variable::DirectionRate(0)),
    ("dcy", Variable::DirectionRate(1)),
    ("dcz", Variable::DirectionRate(2)),
    ("F", Variable::Field),
    ("s", Variable::Scalar),
    ("fx", Variable::Flux(0)),
    ("fy", Variable::Flux(1)),
    ("fz", Variable::Flux(2)),
    ("t", Variable::Time),
    ("time_s", Variable::RecordingTime),
    ("depth", Variable::Depth),
    ("temperature", Variable::Temperature),
];

impl Variable {
    /// The variable of a name; columns of the recording that are one are known by their own names too.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "depth_m" => Some(Self::Depth),
            "temperature_degC" => Some(Self::Temperature),
            _ => VARIABLES.iter().find(|(known, _)| *known == name).map(|(_, variable)| *variable),
        }
    }

    /// Its name in a formula.
    pub fn name(self) -> &'static str {
        VARIABLES.iter().find(|(_, variable)| *variable == self).map_or("", |(name, _)| name)
    }
}
