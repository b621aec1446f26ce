note: real_time: the scene takes 0.479 of the time there is on one core, with 17 substeps, 69 segments of fibre 'cable' (accuracy 1.55 % of substeps, 1.25 % of segments)
3.973 user
