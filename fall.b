note: real_time: the scene takes 0.496 of the time there is on one core, with 25 substeps, 19 segments of fibre 'cable' (accuracy 2.91 % of substeps, 2.62 % of segments)
4.574 user
