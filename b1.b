note: real_time: the scene takes 0.481 of the time there is on one core, with 36 substeps, 233 segments of fibre 'cable' (accuracy 0.0166 % of substeps, 0.0166 % of segments)
4.483 user
