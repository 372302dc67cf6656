//! Makes the list of an assembly's variables, part by part.

use std::collections::BTreeSet;

use bolted_joint_assembly::AssemblyModel;
use bolted_joint_dynamics::{
    Dof,
    assembly::Assembly,
    law::{Declaration, INNER_PLACES, Remembered},
};

use super::variables::{
    List, Listed, Places, Role, TypeOf, displacement, displacement_type, load, load_type, of_joint,
    place, rate, rate_type, short, shown,
};

impl List {
    /// The variables of an assembly, in the library's order.
    pub(super) fn of(model: &AssemblyModel, assembly: &Assembly) -> Self {
        let mut maker = Maker {
            model,
            assembly,
            places: Places::of(assembly),
            variables: Vec::new(),
        };
        maker.loads();
        maker.preloads();
        maker.states();
        let memory = maker.memory();
        maker.inner(&memory);
        maker.motions();
        maker.joint_loads();
        maker.remembered(&memory);
        let apart = maker.variables.len();
        maker.energies();
        maker.accelerations();
        maker.inner_rates(&memory);
        maker.indicators();
        Self {
            variables: maker.variables,
            apart,
        }
    }
}

/// A number that a law of a joint remembers and that is a variable.
struct Memory {
    joint: usize,
    dof: &'static Dof,
    law: &'static Declaration,
    number: &'static Remembered,
    is_inner: bool,
}

struct Maker<'m> {
    model: &'m AssemblyModel,
    assembly: &'m Assembly,
    places: Places,
    variables: Vec<Listed>,
}

impl Maker<'_> {
    fn add(
        &mut self,
        name: String,
        role: Role,
        declared_type: TypeOf,
        description: String,
    ) -> &mut Listed {
        let place = self.variables.len();
        self.variables.push(Listed {
            name,
            is_output: matches!(role, Role::Output | Role::Inner),
            role,
            declared_type,
            description,
            derivative_of: None,
            on: Vec::new(),
            initially_on: Vec::new(),
            start: 0.0,
        });
        &mut self.variables[place]
    }

    fn loads(&mut self) {
        let model = self.model;
        for input in &model.inputs {
            let dof = input.letters();
            let name = format!("{}.{}", input.name, dof.load);
            let description = format!(
                "{} on {}; held over a step in Co-Simulation, unless the importer says how it goes on",
                load(dof.kind),
                place(model, input)
            );
            self.add(
                name,
                Role::Input,
                TypeOf::Named(load_type(dof.kind)),
                description,
            );
        }
    }

    fn preloads(&mut self) {
        let model = self.model;
        for joint in &model.joints {
            let Some(table) = joint.table() else { continue };
            let description = format!(
                "Tightening torque of the bolt of joint {}; held over a step in Co-Simulation, unless the importer says how it \
                 goes on",
                joint.name
            );
            let own = self.add(
                format!("{}.preload", joint.name),
                Role::Limited,
                TypeOf::OfLap("preload".to_owned()),
                description,
            );
            own.start = table.nominal;
        }
    }

    /// Place of the preload of a joint, if it has one.
    fn preload_of(&self, joint: usize) -> Option<usize> {
        let joints = &self.assembly.joints;
        joints.get(joint)?.over_preload.as_ref()?;
        let before = joints.iter().take(joint);
        let before = before.filter(|joint| joint.over_preload.is_some()).count();
        Some(self.places.loads + before)
    }

    fn states(&mut self) {
        for (quantity, of) in [("q", None), ("v", Some(()))] {
            for coordinate in 0..self.places.size {
                let omega = self.assembly.frequencies_rad_per_s[coordinate];
                let shape = self.largest_shape(coordinate);
                // as far as the points of a structure usually go, and no faster than these
                let rate = 0.1 / shape;
                let displacement = (1e-4 / shape).min(rate / omega.max(1.0));
                let (declared_type, nominal, what) = match of {
                    None => ("Displacement", displacement, "Coordinate"),
                    Some(()) => ("Velocity", rate, "Rate of coordinate"),
                };
                let description = format!(
                    "{what} {} of the structures, with a mass of 1 kg and {} Hz",
                    coordinate + 1,
                    short(omega / std::f64::consts::TAU)
                );
                let derivative_of = of.map(|()| self.places.q(coordinate));
                let own = self.add(
                    format!("modal.{quantity}{}", coordinate + 1),
                    Role::State,
                    TypeOf::OfMagnitude(declared_type, nominal.log10().round() as i32),
                    description,
                );
                own.derivative_of = derivative_of;
            }
        }
        // as derivatives of the coordinates, the rates depend on themselves
        let places = self.places;
        for coordinate in 0..places.size {
            self.variables[places.v(coordinate)].on = vec![places.v(coordinate)];
        }
        for (name, description) in [
            ("energy.supplied", "Work of the loads since the start"),
            (
                "energy.dissipated",
                "Heat from structures and joints since the start",
            ),
        ] {
            let own = self.add(
                name.to_owned(),
                Role::State,
                TypeOf::Named("Energy"),
                description.to_owned(),
            );
            own.is_output = true;
        }
    }

    /// The largest entry of a coordinate's shape at loads, motions and joints.
    fn largest_shape(&self, coordinate: usize) -> f64 {
        let loads = self.assembly.loads.row(coordinate).iter().copied();
        let outputs = self.model.output_rows();
        let joints = self.assembly.joints.iter().flat_map(|joint| {
            (0..joint.relative.rows()).map(move |row| joint.relative[(row, coordinate)])
        });
        let motions = (0..outputs.nrows()).map(|row| outputs[(row, coordinate)]);
        let all = loads.chain(joints).chain(motions);
        let largest = all.map(f64::abs).fold(0.0, f64::max);
        if largest > 0.0 { largest } else { 1.0 }
    }

    fn motions(&mut self) {
        let (model, places) = (self.model, self.places);
        let rows = model.output_rows();
        for (row, output) in model.outputs.iter().enumerate() {
            let dof = output.letters();
            let own: Vec<usize> = (0..places.size)
                .filter(|&i| rows[(row, i)] != 0.0)
                .collect();
            for (name, declared_type, what, of) in [
                (
                    dof.name,
                    displacement_type(dof.kind),
                    displacement(dof.kind),
                    Places::q as fn(_, _) -> _,
                ),
                (dof.rate, rate_type(dof.kind), rate(dof.kind), Places::v),
            ] {
                let description = format!("{what} of {}", place(model, output));
                let name = format!("{}.{name}", output.name);
                let on: Vec<usize> = own.iter().map(|&i| of(places, i)).collect();
                let displacement = self.variables.len() - 1;
                let is_rate = declared_type == rate_type(dof.kind);
                let listed = self.add(
                    name,
                    Role::Output,
                    TypeOf::Named(declared_type),
                    description,
                );
                listed.derivative_of = is_rate.then_some(displacement);
                listed.on.clone_from(&on);
                listed.initially_on = on;
            }
        }
    }

    fn joint_loads(&mut self) {
        let model = self.model;
        for (place, joint) in model.joints.iter().enumerate() {
            let on = self.of_joint(place);
            for dof in joint.file.joint.dofs.rows() {
                let name = format!("{}.{}", joint.name, dof.load);
                let description = format!(
                    "{} that joint {} puts on side b; side a takes the opposite",
                    load(dof.kind),
                    joint.name
                );
                let own = self.add(
                    name,
                    Role::Output,
                    TypeOf::Named(load_type(dof.kind)),
                    description,
                );
                own.on.clone_from(&on);
                own.initially_on.clone_from(&on);
            }
        }
    }

    /// Places of the states and inputs that a joint's loads depend on.
    fn of_joint(&self, joint: usize) -> Vec<usize> {
        let coordinates = self.coordinates_of(joint);
        let mut on: Vec<usize> = coordinates.iter().map(|&i| self.places.q(i)).collect();
        on.extend(coordinates.iter().map(|&i| self.places.v(i)));
        let inner = self.memory();
        let inner = inner.iter().filter(|memory| memory.is_inner).enumerate();
        on.extend(
            inner
                .filter(|(_, memory)| memory.joint == joint)
                .map(|(which, _)| self.places.inner(which)),
        );
        on.extend(self.preload_of(joint));
        on.sort_unstable();
        on
    }

    /// Coordinates that move a joint.
    fn coordinates_of(&self, joint: usize) -> BTreeSet<usize> {
        let relative = &self.assembly.joints[joint].relative;
        (0..self.places.size)
            .filter(|&i| (0..relative.rows()).any(|row| relative[(row, i)] != 0.0))
            .collect()
    }

    /// All numbers that laws remember and that are variables, in the library's order.
    fn memory(&self) -> Vec<Memory> {
        let joints = self.assembly.joints.iter().enumerate();
        joints
            .flat_map(|(joint, own)| {
                let dofs = self.model.joints[joint].file.joint.dofs.rows();
                own.laws.iter().zip(dofs).flat_map(move |(laws, dof)| {
                    shown(laws).map(move |(place, law, number)| Memory {
                        joint,
                        dof,
                        law,
                        number,
                        is_inner: INNER_PLACES.contains(&place),
                    })
                })
            })
            .collect()
    }

    fn inner(&mut self, memory: &[Memory]) {
        for own in memory.iter().filter(|own| own.is_inner) {
            self.add_remembered(own, Role::Inner);
        }
    }

    fn remembered(&mut self, memory: &[Memory]) {
        for own in memory.iter().filter(|own| !own.is_inner) {
            self.add_remembered(own, Role::Output);
        }
    }

    fn add_remembered(&mut self, own: &Memory, role: Role) {
        let joint = &self.model.joints[own.joint];
        let declared = own.law.variable(own.number.symbol, own.dof.name);
        let description = format!("{declared} of joint {}", joint.name);
        let places = self.places;
        let coordinates = self.coordinates_of(own.joint);
        let name = of_joint(&joint.name, &declared);
        let listed = self.add(name, role, TypeOf::OfLap(declared), description);
        listed.initially_on = coordinates.iter().map(|&i| places.q(i)).collect();
        listed
            .initially_on
            .extend(coordinates.iter().map(|&i| places.v(i)));
    }

    fn energies(&mut self) {
        let places = self.places;
        let q = || (0..places.size).map(move |i| places.q(i));
        let v = || (0..places.size).map(move |i| places.v(i));
        let inner = self.memory().iter().filter(|own| own.is_inner).count();
        let inner = || (0..inner).map(move |which| places.inner(which));
        let has_laws = self.assembly.laws().next().is_some();
        let preloads = || places.loads..places.inputs();
        // ascending as the references are
        let of_laws_and_rates = || {
            let q = q().filter(move |_| has_laws);
            q.chain(v()).chain(inner().filter(move |_| has_laws))
        };
        for (name, declared_type, energy, on, description) in [
            (
                "energy.stored",
                "Energy",
                None,
                preloads()
                    .chain(q())
                    .chain(v())
                    .chain(inner())
                    .collect::<Vec<_>>(),
                "Energy of motion, and stored in structures and joints",
            ),
            (
                "power.supplied",
                "Power",
                Some(0),
                (0..places.loads).chain(v()).collect(),
                "Power of the loads",
            ),
            (
                "power.dissipated",
                "Power",
                Some(1),
                preloads().chain(of_laws_and_rates()).collect(),
                "Power that structures and joints turn into heat",
            ),
        ] {
            let own = self.add(
                name.to_owned(),
                Role::Output,
                TypeOf::Named(declared_type),
                description.to_owned(),
            );
            own.derivative_of = energy.map(|which| places.energy(which));
            own.on.clone_from(&on);
            own.initially_on = on;
        }
        if places.preloads > 0 {
            let on = preloads().chain(q()).chain(v());
            let on = on
                .chain([places.energy(0), places.energy(1)])
                .chain(inner());
            let on: Vec<usize> = on.collect();
            let own = self.add(
                "energy.preload".to_owned(),
                Role::Output,
                TypeOf::Named("Energy"),
                "Energy that the joints' springs have taken up since the start because preloads changed: negative where they \
                 loosened"
                    .to_owned(),
            );
            own.on = on;
        }
    }

    fn accelerations(&mut self) {
        let (places, assembly) = (self.places, self.assembly);
        let joints: Vec<BTreeSet<usize>> = (0..assembly.joints.len())
            .map(|joint| self.coordinates_of(joint))
            .collect();
        for i in 0..places.size {
            let mut on: BTreeSet<usize> = (0..places.loads)
                .filter(|&load| assembly.loads[(i, load)] != 0.0)
                .collect();
            on.insert(places.q(i));
            let damping = &assembly.damping_per_s;
            on.extend(
                (0..places.size)
                    .filter(|&j| damping[(i, j)] != 0.0)
                    .map(|j| places.v(j)),
            );
            for (joint, _) in joints
                .iter()
                .enumerate()
                .filter(|(_, own)| own.contains(&i))
            {
                on.extend(self.of_joint(joint));
            }
            let own = self.add(
                format!("modal.a{}", i + 1),
                Role::Derivative,
                TypeOf::Named("Acceleration"),
                format!("Acceleration of coordinate {} of the structures", i + 1),
            );
            own.derivative_of = Some(places.v(i));
            own.on = on.into_iter().collect();
            own.initially_on.clone_from(&own.on);
        }
    }

    fn inner_rates(&mut self, memory: &[Memory]) {
        let places = self.places;
        let inner = memory.iter().filter(|own| own.is_inner).enumerate();
        for (which, own) in inner {
            let Some(rate) = &own.number.rate else {
                continue;
            };
            let joint = &self.model.joints[own.joint];
            let declared = own.law.variable(rate.symbol, own.dof.name);
            let description = format!("{declared} of joint {}", joint.name);
            let name = of_joint(&joint.name, &declared);
            let on = self.of_joint(own.joint);
            let listed = self.add(name, Role::Derivative, TypeOf::OfLap(declared), description);
            listed.derivative_of = Some(places.inner(which));
            listed.on.clone_from(&on);
            listed.initially_on = on;
        }
    }

    fn indicators(&mut self) {
        let places = self.places;
        let mut turning = Vec::new();
        for (place, joint) in self.assembly.joints.iter().enumerate() {
            let dofs = self.model.joints[place].file.joint.dofs.rows();
            for (laws, dof) in joint.laws.iter().zip(dofs) {
                if laws.present().any(Declaration::commits) {
                    turning.push((place, dof));
                }
            }
        }
        for is_ahead in [false, true] {
            for &(joint, dof) in &turning {
                let pattern = match is_ahead {
                    false => "joint.turning",
                    true => "joint.ahead",
                };
                let declared = format!("{pattern}_{}", dof.name);
                let owner = &self.model.joints[joint].name;
                let description = format!("{declared} of joint {owner}");
                let name = of_joint(owner, &declared);
                let coordinates = self.coordinates_of(joint);
                let on = coordinates.iter().map(|&i| match is_ahead {
                    false => places.v(i),
                    true => places.q(i),
                });
                let on: Vec<usize> = on.collect();
                let own = self.add(name, Role::Indicator, TypeOf::OfLap(declared), description);
                own.on.clone_from(&on);
                own.initially_on = on;
            }
        }
    }
}
