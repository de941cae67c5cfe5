#include "bentaxis/pump/inputs.h"

namespace bentaxis {

std::vector<PumpInput> continuous_inputs(PumpParameters& p) {
  std::vector<PumpInput> list = {
      {"geometry.tilt", &p.geometry.tilt},
      {"geometry.joint_circle_radius", &p.geometry.joint_circle_radius},
      {"geometry.bore_circle_radius", &p.geometry.bore_circle_radius},
      {"geometry.axis_offset", &p.geometry.axis_offset},
      {"geometry.piston_length", &p.geometry.piston_length},
      {"geometry.bore_diameter", &p.geometry.bore_diameter},
      {"gear.pitch_diameter", &p.gear.pitch_diameter},
      {"gear.pressure_angle", &p.gear.pressure_angle},
      {"bearings.tapered_z", &p.bearings.tapered_z},
      {"bearings.cylindrical_z", &p.bearings.cylindrical_z},
      {"piston.mass", &p.piston.mass},
      {"piston.joint_mass_fraction", &p.piston.joint_mass_fraction},
      {"shaft.mass", &p.shaft.mass},
      {"shaft.centre_of_mass_z", &p.shaft.centre_of_mass_z},
      {"shaft.axial_inertia", &p.shaft.axial_inertia},
      {"block.mass", &p.block.mass},
      {"block.centre_of_mass_z", &p.block.centre_of_mass_z},
      {"block.pin_z", &p.block.pin_z},
      {"block.bottom_area", &p.block.bottom_area},
      {"block.spring_force", &p.block.spring_force},
      {"block.axial_inertia", &p.block.axial_inertia},
      {"friction.piston_coulomb", &p.friction.piston_coulomb},
      {"friction.piston_viscous", &p.friction.piston_viscous},
      {"friction.regularization", &p.friction.regularization},
      {"friction.block_viscous", &p.friction.block_viscous},
      {"friction.shaft_viscous", &p.friction.shaft_viscous},
      {"friction.shaft_torque_factor", &p.friction.shaft_torque_factor},
      {"gravity", &p.gravity},
  };
  if (p.piston.real) {
    list.push_back({"piston.real.centre_of_mass", &p.piston.real->centre_of_mass});
    list.push_back({"piston.real.transverse_inertia", &p.piston.real->transverse_inertia});
    list.push_back({"piston.real.axial_inertia", &p.piston.real->axial_inertia});
    list.push_back({"piston.real.spin", &p.piston.real->spin});
  }
  if (p.port_plate) {
    PortPlate& plate = *p.port_plate;
    list.push_back({"port_plate.r1", &plate.r1});
    list.push_back({"port_plate.r2", &plate.r2});
    list.push_back({"port_plate.r3", &plate.r3});
    list.push_back({"port_plate.r4", &plate.r4});
    list.push_back({"port_plate.delivery.from_deg", &plate.delivery.from_deg});
    list.push_back({"port_plate.delivery.to_deg", &plate.delivery.to_deg});
    list.push_back({"port_plate.suction.from_deg", &plate.suction.from_deg});
    list.push_back({"port_plate.suction.to_deg", &plate.suction.to_deg});
  }
  return list;
}

}  // namespace bentaxis
