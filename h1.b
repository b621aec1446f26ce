note: real_time: the scene takes 0.494 of the time there is on one core, with 166 substeps, 63 segments of fibre 'cable' (accuracy 0.286 % of substeps, 0.232 % of segments)
4.414 user
