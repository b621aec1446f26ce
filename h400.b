note: real_time: the scene takes 0.487 of the time there is on one core, with 8 substeps, 14 segments of fibre 'cable' (accuracy 6.08 % of substeps, 4.92 % of segments)
warning: the 400 fibres pass through each other: the effect fiber_contact is not named
5.712 user
